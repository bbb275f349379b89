// Figures for papers, without a browser: every figure as SVG, CSV and PDF.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import {
  existsSync,
  mkdirSync,
  readdirSync,
  readFileSync,
  rmSync,
  statSync,
  symlinkSync,
  writeFileSync,
} from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { csvRows, folderOf, frahm, stored, study } from "./page.mjs";

// Of one file of figures: well-formed, with words in it, and drawn by a renderer of SVG.
function check(folder, name) {
  const svg = join(folder, `${name}.svg`),
    png = join(folder, `${name}.png`);
  execFileSync("/usr/bin/python3", ["-c", "import sys, xml.dom.minidom as m; m.parse(sys.argv[1])", svg]);
  const text = readFileSync(svg, "utf8");
  assert.match(text, /<title>[^<]+<\/title><desc>[^<]*fingerprint/);
  assert.doesNotMatch(text, /NaN|undefined|Infinity/, `${name}.svg`);
  execFileSync("rsvg-convert", [svg, "-o", png]);
  assert.ok(statSync(png).size > 3000, `${name}: an empty picture`);
  assert.ok(readFileSync(join(folder, `${name}.csv`), "utf8").includes(","));
  assert.equal(
    readFileSync(join(folder, `${name}.pdf`))
      .subarray(0, 5)
      .toString(),
    "%PDF-",
  );
}

test("a map's figures are files that other programs read", (t) => {
  const folder = folderOf(t),
    file = join(folder, "hundal.h5"),
    figures = join(folder, "new", "figures");
  frahm(["run", study("hundal"), "-o", file, "--progress", "none"]);
  frahm(["report", file, "--figures", figures]);
  const names = readdirSync(figures)
    .filter((name) => name.endsWith(".svg"))
    .map((name) => name.slice(0, -4));
  assert.ok(
    names.some((name) => name.startsWith("map_")) && names.some((name) => name.startsWith("curves_")),
    names.join(),
  );
  for (const name of names) check(figures, name);
  assert.deepEqual(
    readdirSync(figures).filter((name) => !/\.(svg|csv|pdf|png)$/.test(name)),
    [],
  );
});

test("who dissipates along an axis is a figure for papers too", (t) => {
  const folder = folderOf(t),
    file = join(folder, "shares.h5");
  frahm(["run", study("rig_energy_shares"), "-o", file, "--progress", "none"]);
  frahm(["report", file, "--figures", folder]);
  check(folder, "damping_budget");
});

test("the numbers of a curve are those of the file", (t) => {
  const folder = folderOf(t),
    file = join(folder, "h.h5");
  frahm(["run", study("lecture_hysteretic"), "-o", file, "--progress", "none"]);
  frahm(["report", file, "--figures", folder]);
  const rows = csvRows(readFileSync(join(folder, "curves_main_amplitude.csv"), "utf8"));
  const first = stored(file, "main_amplitude", [0, 0]);
  const shown = Object.entries(rows[0]).find(([name]) => name.startsWith("main_amplitude"))[1];
  assert.equal(Number(shown), first);
});

test("figures replace figures that nobody has changed, and nothing else", (t) => {
  const folder = folderOf(t),
    file = join(folder, "h.h5"),
    figures = join(folder, "figures"),
    place = (name) => join(figures, `curves_main_amplitude.${name}`);
  frahm(["run", study("lecture_hysteretic"), "-o", file, "--progress", "none"]);
  const draw = (code = 0) => frahm(["report", file, "--figures", figures], { code });
  draw();
  const all = () => Object.fromEntries(readdirSync(figures).map((name) => [name, readFileSync(join(figures, name))]));
  draw();
  const isRefused = (extension, content, why) => {
    const path = place(extension),
      kept = readFileSync(path);
    writeFileSync(path, content);
    const before = all();
    assert.match(draw(6), why);
    assert.deepEqual(all(), before);
    writeFileSync(path, kept);
  };
  isRefused("svg", "<svg>mine</svg>", /curves_main_amplitude\.svg: exists already and is not a figure/);
  isRefused("svg", readFileSync(place("svg"), "utf8").replace("</title>", " of mine</title>"), /changed since/);
  isRefused("pdf", "%PDF-1.4 mine", /curves_main_amplitude\.pdf: exists already/);
  isRefused("csv", readFileSync(file), /curves_main_amplitude\.csv: exists already/);
  rmSync(place("svg"));
  writeFileSync(join(folder, "mine.svg"), "mine");
  symlinkSync(join(folder, "mine.svg"), place("svg"));
  assert.match(draw(6), /curves_main_amplitude\.svg: is a link/);
  assert.equal(readFileSync(join(folder, "mine.svg"), "utf8"), "mine");
  rmSync(place("svg"));
  draw();
});

test("what cannot be done is said, with its exit code", (t) => {
  const folder = folderOf(t),
    file = join(folder, "h.h5");
  frahm(["run", study("lecture_springs"), "-o", file, "--progress", "none"]);
  assert.match(
    frahm(["report", file, "--quantities", "nothing"], { code: 2 }),
    /no quantity "nothing"; known: /,
  );
  assert.match(
    frahm(["report", join(folder, "absent.h5")], { code: 6 }),
    /absent\.h5: there is no such file/,
  );
  assert.match(frahm(["report", study("hundal")], { code: 2 }), /hundal\.toml/);
  assert.match(frahm(["report", file, "-o", file], { code: 6 }), /is the input file/);
  writeFileSync(join(folder, "taken"), "");
  assert.match(frahm(["report", file, "--figures", join(folder, "taken")], { code: 6 }), /taken/);
  mkdirSync(join(folder, "page.html"));
  frahm(["report", file, "-o", join(folder, "page.html")], { code: 6 });
  assert.ok(!existsSync(join(folder, "h.html")));
});
