// Every figure of a result as SVG and its numbers as CSV, without a browser:  node FIGURES.mjs FOLDER < DATA.json
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { DOMImplementation, XMLSerializer } from "@xmldom/xmldom";
import { csvText } from "./csv.js";
import { figuresOf } from "./pages/pages.js";
import { pngImage } from "./png.mjs";
import { unpackRecord } from "./record.js";
import { svgFile } from "./svg_file.js";

const folder = process.argv[2];
const record = await unpackRecord(JSON.parse(readFileSync(0, "utf8")));
const document = new DOMImplementation().createDocument("http://www.w3.org/1999/xhtml", "html");

function write(figure) {
  const svg = svgFile(figure, record, { document, image: pngImage });
  writeFileSync(join(folder, `${figure.name}.svg`), new XMLSerializer().serializeToString(svg));
  writeFileSync(join(folder, `${figure.name}.csv`), csvText(figure.table()));
  process.stdout.write(`${figure.name}\n`);
}

// A figure that cannot be drawn does not stop the others.
for (const figure of figuresOf(record)) {
  try {
    write(figure);
  } catch (error) {
    process.stderr.write(`frahm: the figure ${figure.name} could not be drawn: ${error.message}\n`);
    process.exitCode = 1;
  }
}
