// What the tests of pages share: runs the program, opens its page in a headless Chromium from file://, and keeps
// whatever the browser complains of.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { after } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

// Set by CTest.
const program = process.env.FRAHM;
const chromiumPath = process.env.FRAHM_CHROMIUM;
const screenshots = process.env.FRAHM_SCREENSHOTS;
const { chromium } = createRequire(join(process.env.FRAHM_NODE_MODULES, "page.cjs"))("playwright-core");

// Set to `all` by `./bootstrap checks long`: some tests take a few kinds of pages otherwise.
export const everyKind = process.env.FRAHM_PAGES === "all";

export const sources = join(dirname(fileURLToPath(import.meta.url)), "..", "..", "..");

// The file of one of the project's studies by its name; the folders under studies/ are by topic.
export function study(name) {
  const found = readdirSync(join(sources, "studies"), { recursive: true }).find(
    (path) => basename(path) === `${name}.toml`,
  );
  assert.ok(found, `there is a study ${name}`);
  return join(sources, "studies", found);
}

// A folder of the test's own; removed at its end.
export function folderOf(test) {
  const folder = mkdtempSync(join(tmpdir(), "frahm-page-"));
  test.after(() => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

// Runs frahm; code: the exit code that is right. Its standard output.
export function frahm(args, { code = 0 } = {}) {
  try {
    const text = execFileSync(program, args, {
      encoding: "utf8",
      stdio: ["ignore", "pipe", "pipe"],
      timeout: 240_000,
    });
    assert.equal(0, code, `frahm ${args.join(" ")} ended with code 0`);
    return text;
  } catch (error) {
    if (error.status === undefined || error.status === null) throw error;
    assert.equal(error.status, code, `frahm ${args.join(" ")}\n${error.stderr}`);
    return error.stdout + error.stderr;
  }
}

// One number of a result, read by an HDF5 library that is not ours.
export function stored(file, dataset, index = []) {
  const code =
    "import sys, json, h5py\nfile, name, index = sys.argv[1:4]\n" +
    "print(repr(float(h5py.File(file)[name][tuple(json.loads(index))])))";
  return Number(
    execFileSync("/usr/bin/python3", ["-c", code, file, dataset, JSON.stringify(index)], {
      encoding: "utf8",
    }),
  );
}

// The numbers, flags (as their words) and texts of a group of a result, by name, read by an HDF5 library that is not
// ours. A number alone, or an array.
export function recordOf(file, group) {
  const code = `
import sys, json, h5py
found = {}
where = h5py.File(sys.argv[1])[sys.argv[2]]
for name, text in where.attrs.items():
    if isinstance(text, (str, bytes)):
        found[name] = text.decode() if isinstance(text, bytes) else text
for name, data in where.items():
    if not isinstance(data, h5py.Dataset) or data.dtype.kind not in "fiu":
        continue
    values = data[()]
    if "flag_meanings" in data.attrs:
        meanings = data.attrs["flag_meanings"]
        meanings = (meanings.decode() if isinstance(meanings, bytes) else meanings).split()
        words = dict(zip([int(value) for value in data.attrs["flag_values"]], meanings))
        values = [words[int(value)] for value in values.flat]
    else:
        values = [float(value) for value in values.flat]
    found[name] = values[0] if data.shape in ((), (1,)) else values
print(json.dumps(found))`;
  const text = execFileSync("/usr/bin/python3", ["-c", code, file, group], {
    encoding: "utf8",
    maxBuffer: 1 << 28,
  });
  return JSON.parse(text.replace(/\bNaN\b/g, '"NaN"').replace(/-?\bInfinity\b/g, '"$&"'), (key, value) =>
    ["NaN", "Infinity", "-Infinity"].includes(value) ? Number(value) : value,
  );
}

// One browser for all tests of a file: it takes a second to start. Those that stopped drawing are kept to the end.
let browser;
const browsers = [];
const launch = async () => {
  browser = await chromium.launch({ executablePath: chromiumPath, args: ["--no-sandbox"] });
  browsers.push(browser);
};
export const closeBrowser = () => Promise.all(browsers.map((each) => each.close()));
after(closeBrowser);

async function isReady(page) {
  await page.waitForFunction(() => document.body.dataset.state !== undefined, null, { timeout: 60_000 });
  return page.evaluate(() => document.body.dataset.state === "ready");
}

function areDrawn(page) {
  return page.waitForFunction(
    () => [...document.querySelectorAll(".plot")].every((plot) => plot.querySelector("svg")),
    null,
    { timeout: 60_000 },
  );
}

// A page in a session of its own; closed at the end of the test. {page, complaints}.
export async function open(
  test,
  file,
  { width = 1280, height = 900, colorScheme = "light", hasTouch = false } = {},
) {
  if (!browser) await launch();
  const context = await browser.newContext({
    viewport: { width, height },
    colorScheme,
    hasTouch,
    isMobile: hasTouch,
    acceptDownloads: true,
  });
  test.after(() => context.close());
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`asks for ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href);
  assert.ok(await isReady(page), complaints.join("\n"));
  await areDrawn(page);
  return { page, complaints };
}

// The text of the file that a button gives.
export async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  return { name: download.suggestedFilename(), text: readFileSync(await download.path(), "utf8") };
}

// Whether a number is told as the page tells it: to six digits, the last uncertain by one.
export function isTold(shown, value) {
  const last = 10 ** (Math.floor(Math.log10(Math.abs(value))) - 5);
  return Math.abs(shown - value) <= last;
}

// Rows of a CSV text by the names of its head.
export function csvRows(text) {
  const [head, ...lines] = text
    .trimEnd()
    .split("\n")
    .map((line) => line.split(","));
  return lines.map((cells) => Object.fromEntries(head.map((name, c) => [name, cells[c]])));
}

// A picture of a page. On a busy machine Chromium may, rarely, draw no frame any more, however often it is asked: then
// another browser draws the page, and opens the pages that follow.
async function pictureOf(page, options, media) {
  try {
    return await page.screenshot(options);
  } catch (error) {
    if (error.name !== "TimeoutError") throw error;
  }
  console.log("Chromium drew no frame within 30 s; another one is started");
  await launch();
  const again = await browser.newPage({ viewport: page.viewportSize() });
  await again.emulateMedia({ media });
  await again.goto(page.url());
  assert.ok(await isReady(again), "the page opens in another browser too");
  await areDrawn(again);
  const picture = await again.screenshot(options);
  await again.close();
  return picture;
}

// Pictures of a page as a phone, a laptop and a printer show it, and nothing wider than the window.
export async function photographed(page, name) {
  if (screenshots) mkdirSync(screenshots, { recursive: true });
  const keep = async (kind, width, media = "screen") => {
    // A window as high as the page: of a picture that goes beyond its window (fullPage) Chromium may draw no frame
    // on a busy machine, however often it is asked.
    const height = await page.evaluate(() => document.documentElement.scrollHeight);
    await page.setViewportSize({ width, height });
    const options = screenshots ? { path: join(screenshots, `${name}_${kind}.png`) } : {};
    const picture = await pictureOf(page, options, media);
    assert.ok(picture.length > 10_000, `${name} ${kind}: an empty picture`);
  };
  for (const [kind, width, height] of [
    ["phone", 390, 844],
    ["laptop", 1280, 800],
  ]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(300);
    assert.ok(
      await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth + 1),
      `${name} is wider than a ${kind}`,
    );
    await keep(kind, width);
  }
  await page.setViewportSize({ width: 794, height: 1123 }); // A4 at 96 dots an inch
  await page.emulateMedia({ media: "print" });
  await page.waitForTimeout(300);
  await keep("print", 794, "print");
  await page.emulateMedia({ media: "screen" });
}

// Labels of figures that lie over each other or stand out of their figure.
export async function badLabels(page) {
  return page.evaluate(() => {
    const bad = [];
    for (const svg of document.querySelectorAll(".plot svg")) {
      const frame = svg.getBoundingClientRect();
      const labels = [...svg.querySelectorAll("text, tspan:not(text > tspan)")].filter(
        (text) => text.textContent.trim() && !text.closest("[aria-label=tip], [data-mark=tip]"),
      );
      const boxes = labels
        .map((text) => ({ text: text.textContent, box: text.getBoundingClientRect() }))
        .filter(({ box }) => box.width > 0);
      for (const { text, box } of boxes) {
        if (
          box.left < frame.left - 2 ||
          box.right > frame.right + 2 ||
          box.top < frame.top - 2 ||
          box.bottom > frame.bottom + 2
        )
          bad.push(`"${text}" is cut off`);
      }
      for (let a = 0; a < boxes.length; ++a) {
        for (let b = a + 1; b < boxes.length; ++b) {
          const [p, q] = [boxes[a].box, boxes[b].box];
          const over = Math.min(p.right, q.right) - Math.max(p.left, q.left),
            above = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
          if (over > 2 && above > 3) bad.push(`"${boxes[a].text}" lies over "${boxes[b].text}"`);
        }
      }
    }
    return bad;
  });
}
