// A figure on the page: drawn to the width there is, with buttons for its SVG and its CSV.
import { csvText } from "../csv.js";
import { svgFile } from "../svg_file.js";
import { element } from "./elements.js";

const paperWidth = 720,
  ratio = 0.6; // of an exported figure; height over width of all
const leastHeight = 260,
  mostHeight = 560;

// A picture's data URL by the browser's own encoder.
function image(width, height, rgba) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  canvas.getContext("2d").putImageData(new ImageData(rgba, width, height), 0, 0);
  return canvas.toDataURL("image/png");
}

function canvasOf(width, figure, interactive) {
  const height = Math.min(mostHeight, Math.max(leastHeight, Math.round(width * (figure.ratio ?? ratio))));
  return { width, height, document, image, interactive };
}

function download(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = element("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

// about: where the figures come from. Returns {card, redraw, drawn: the SVG element shown}.
export function figureCard(figure, about) {
  const plot = element("div", { class: "plot" });
  const heading = element("h3", {}, figure.title);
  const caption = element("figcaption", {}, figure.caption ?? "");
  const name = () => (typeof figure.name === "function" ? figure.name() : figure.name);
  const save = element(
    "div",
    { class: "save" },
    element(
      "button",
      {
        type: "button",
        class: "save-svg",
        title: "this figure as SVG, for a paper",
        onclick: () => {
          const title = [figure.title, figure.caption].filter(Boolean).join("; ");
          const svg = svgFile(figure.draw(canvasOf(paperWidth, figure, false)), title, about);
          download(`${name()}.svg`, "image/svg+xml", new XMLSerializer().serializeToString(svg));
        },
      },
      "SVG",
    ),
    element(
      "button",
      {
        type: "button",
        class: "save-csv",
        title: "its numbers as CSV",
        onclick: () => {
          download(`${name()}.csv`, "text/csv", csvText(figure.table()));
        },
      },
      "CSV",
    ),
  );
  const card = element(
    "figure",
    { class: "card", "data-figure": name() },
    element("header", {}, heading, save),
    plot,
    caption,
  );
  const shown = { card, plot, svg: null, redraw };
  function redraw() {
    const width = Math.floor(plot.clientWidth);
    if (width < 50) return;
    heading.textContent = figure.title;
    caption.textContent = figure.caption ?? "";
    try {
      shown.svg = figure.draw(canvasOf(width, figure, true));
      plot.replaceChildren(shown.svg);
    } catch (error) {
      plot.replaceChildren(
        element("p", { class: "failure" }, `This figure could not be drawn: ${error.message}`),
      );
      throw error;
    }
  }
  let before = 0;
  new ResizeObserver(() => {
    const width = Math.floor(plot.clientWidth);
    if (Math.abs(width - before) < 2) return;
    before = width;
    redraw();
  }).observe(plot);
  return shown;
}
