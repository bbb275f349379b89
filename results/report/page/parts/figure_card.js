// A figure on the page: drawn to the available width, with buttons for its SVG and its CSV.
import { csvText } from "../csv.js";
import { svgFile } from "../svg_file.js";
import { element } from "./elements.js";

const ratio = 0.6; // height over width, unless the figure states it
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

function canvasOf(width, figure) {
  const height = Math.min(mostHeight, Math.max(leastHeight, Math.round(width * (figure.ratio ?? ratio))));
  return { width, height, document, image, interactive: true };
}

// The figure has one name, its own; Plot's names of its parts, "line" and "dot", would be read out each.
function nameMarks(svg) {
  for (const part of svg.querySelectorAll("[aria-label]")) {
    part.dataset.mark = part.getAttribute("aria-label");
    part.removeAttribute("aria-label");
  }
}

function download(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = element("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

// record: the result that the figure shows. Returns {card, plot: the figure's container, svg: as shown, redraw}.
export function figureCard(figure, record) {
  const plot = element("div", { class: "plot" });
  const heading = element("h3", {}, figure.title);
  const caption = element("figcaption", {}, figure.caption ?? "");
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
          const svg = svgFile(figure, record, { document, image });
          download(`${figure.name}.svg`, "image/svg+xml", new XMLSerializer().serializeToString(svg));
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
          download(`${figure.name}.csv`, "text/csv", csvText(figure.table()));
        },
      },
      "CSV",
    ),
  );
  const card = element(
    "figure",
    { class: "card", "data-figure": figure.name },
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
      shown.svg = figure.draw(canvasOf(width, figure));
      shown.svg.setAttribute("role", "img");
      shown.svg.setAttribute("aria-label", [figure.title, figure.caption].filter(Boolean).join(". "));
      nameMarks(shown.svg);
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
