// Pages of sweeps that are not whole, and of studies whose texts would be markup.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { folderOf, frahm, open, photographed, study } from "./page.mjs";

const hostile =
  "</script><script>document.title='taken'</script><img src=x onerror=alert(1)> & \"quotes\" \u2028 <!--";

// A copy of a study with some of its lines changed.
function changed(folder, name, changes) {
  let text = readFileSync(study(name), "utf8");
  for (const [from, to] of changes) {
    assert.match(text, from);
    text = text.replace(from, to);
  }
  const path = join(folder, `${name}.toml`);
  writeFileSync(path, text);
  return path;
}

test("a partial map shows what there is and says what is missing", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "part.h5");
  const path = changed(folder, "den_hartog", []);
  frahm(["run", path, "-o", file, "--shard", "0/3", "--progress", "none"]);
  frahm(["merge", file, "--partial"]);
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "part.html"));
  assert.match(
    await page.locator(".warning").first().textContent(),
    /part of a map: \d+ of its tiles were not computed/,
  );
  assert.ok((await page.locator(".plot image").count()) > 0);
  await photographed(page, "partial");
  assert.deepEqual(complaints, []);
});

test("a map of failed points names them and their reasons", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "stiff.h5"),
    path = join(folder, "stiff.toml");
  writeFileSync(
    path,
    `[study]
schema = 1
kind = "sweep"
title = "Some points are too stiff for their period"
units = "SI"
[parameters]
k = 1e3
w = 1.0
[[mass]]
name = "m"
mass = 1.0
[[element]]
name = "s"
type = "spring"
between = ["ground", "m"]
stiffness = "k"
[[element]]
name = "g"
type = "coulomb"
between = ["ground", "m"]
force = 0.1
[excitation]
frequency = "w"
[[excitation.force]]
on = "m"
amplitude = 1.0
[[axis]]
parameter = "k"
values = [1e3, 1e16]
[[axis]]
parameter = "w"
from = 1
to = 2
points = 5
`,
  );
  frahm(["run", path, "-o", file, "--progress", "none"], { code: 3 });
  frahm(["report", file]);
  const { page, complaints } = await open(t, join(folder, "stiff.html"));
  assert.match(await page.locator(".warning").first().textContent(), /5 of 10 points failed/);
  assert.match(
    await page.locator("section", { hasText: "Points that failed" }).locator("pre").first().textContent(),
    /k=1e\+16|k = 1e\+16|1e\+16/,
  );
  assert.deepEqual(complaints, []);
});

test("a page says that others may exist, whatever quantities it shows", async (t) => {
  const folder = folderOf(t);
  const notes = async (name, elements, r, quantity) => {
    const file = join(folder, `${name}.h5`),
      path = join(folder, `${name}.toml`);
    writeFileSync(
      path,
      `[study]
schema = 1
kind = "sweep"
units = "dimensionless"
[parameters]
r = 1
[[mass]]
name = "x"
mass = 1
[[element]]
name = "spring"
type = "spring"
between = ["ground", "x"]
stiffness = 1
[[element]]
name = "damper"
type = "damper"
between = ["ground", "x"]
damping = 0.04
[[element]]
name = "other"
between = ["ground", "x"]
${elements}
[excitation]
frequency = "r"
[[excitation.force]]
on = "x"
amplitude = 1
[[axis]]
parameter = "r"
values = [${r}]
[output]
quantities = ["${quantity}"]
`,
    );
    frahm(["run", path, "-o", file, "--progress", "none"]);
    frahm(["report", file]);
    const { page, complaints } = await open(t, join(folder, `${name}.html`));
    assert.deepEqual(complaints, []);
    return (await page.locator(".note").allTextContents()).join("\n");
  };
  const free = await notes("free", 'type = "jenkins"\nstiffness = 1\nforce = 10', "0.5, 3", "x_rms");
  assert.match(free, /2 of 2 points show one of a continuum of responses/);
  const fast = await notes("fast", 'type = "gap"\nclearance = [inf, 0]\nstiffness = 100', "2, 6", "x_peak");
  assert.match(fast, /At 1 of 2 points some starts of the search reached no stable response/);
  assert.doesNotMatch(fast, /continuum/);
});

test("hostile text in a title stays text", async (t) => {
  const folder = folderOf(t),
    file = join(folder, "hostile.h5");
  const quoted = JSON.stringify(hostile);
  const path = changed(folder, "den_hartog", [
    [/^title *=.*$/m, `title = ${quoted}`],
    [/^schema/m, `# ${hostile.replace("\u2028", "")}\nschema`],
  ]);
  frahm(["run", path, "-o", file, "--progress", "none"]);
  frahm(["report", file]);
  const html = readFileSync(join(folder, "hostile.html"), "utf8");
  assert.ok(!html.includes("<img src=x"), "markup from the study is in the page");
  const { page, complaints } = await open(t, join(folder, "hostile.html"));
  assert.equal(await page.locator("h1").textContent(), hostile);
  assert.equal((await page.title()).replace(/\s+/g, " "), hostile.replace(/\s+/g, " "));
  assert.equal(await page.locator("img").count(), 0);
  assert.deepEqual(complaints, []);
});
