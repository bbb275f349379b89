// Bundles page/ with the libraries it uses and writes them as one C++ source (see page_parts.hpp).
//   node bundle.mjs NODE_MODULES OUTPUT.cpp
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const [modules, output] = process.argv.slice(2);
const page = join(dirname(fileURLToPath(import.meta.url)), "page");
const esbuild = createRequire(join(modules, "bundle.cjs"))("esbuild");

function bundle(entry, options) {
  const result = esbuild.buildSync({
    entryPoints: [join(page, entry)],
    bundle: true,
    minify: true,
    write: false,
    charset: "utf8",
    nodePaths: [modules],
    legalComments: "inline",
    logLevel: "warning",
    ...options,
  });
  return result.outputFiles[0].text;
}

// The libraries ask that their licences go with them.
function licences() {
  const lock = JSON.parse(readFileSync(join(page, "..", "package-lock.json"), "utf8"));
  const texts = [];
  for (const [path, entry] of Object.entries(lock.packages)) {
    if (!path || entry.dev || entry.optional || path.includes("esbuild")) continue;
    const folder = join(modules, "..", path);
    for (const name of ["LICENSE", "LICENSE.md", "LICENCE", "LICENSE.txt"]) {
      try {
        texts.push(
          `${path.replace("node_modules/", "")} ${entry.version}\n${readFileSync(join(folder, name), "utf8").trim()}`,
        );
        break;
      } catch {
        // another name
      }
    }
  }
  return texts.join("\n\n");
}

const script = bundle("main.js", { format: "iife", target: "es2021" });
if (script.includes("</script")) throw new Error("the script would end its own element");
const style = bundle("style.css", {});
const hash = createHash("sha256").update(script).digest("base64");
const html = readFileSync(join(page, "page.html"), "utf8");
const pieces = { script, style, hash, licences: licences().replaceAll("&", "&amp;").replaceAll("<", "&lt;") };
const [beforeTitle, beforeData, afterData] = html
  .replaceAll(/\{\{(script|style|hash|licences)\}\}/g, (_, name) => pieces[name])
  .split(/\{\{title\}\}|\{\{data\}\}/);
const figures = bundle("figures_for_papers.mjs", { format: "esm", platform: "node", target: "node18" });

// A raw string of any length; g++ takes it as one.
function literal(text) {
  if (text.includes(')frahm"')) throw new Error("the text would end its own literal");
  return `std::string_view(R"frahm(${text})frahm", ${Buffer.byteLength(text)})`;
}

writeFileSync(
  output,
  `#include "results/report/page_parts.hpp"

namespace frahm::results {

const std::string_view page_before_title = ${literal(beforeTitle)};
const std::string_view page_before_data = ${literal(beforeData)};
const std::string_view page_after_data = ${literal(afterData)};
const std::string_view figures_script = ${literal(figures)};

}  // namespace frahm::results
`,
);
