// The scale of a map's colours, at the right of its frame.
import * as Plot from "@observablehq/plot";
import { numberText } from "../units.js";
import { colourSteps, colourTable } from "./colours.js";
import { svgElement } from "./frame.js";
import { textWidth, wrapped } from "./text_lines.js";

const lineHeight = 14;

// The margin that the bar needs: its ticks, and its label, which takes several lines where the frame is low.
export function colourBarMargin(label, range, state, height) {
  const ticks = tickValues(range, state.scale, 6, state.isWhole).map((tick) => textWidth(numberText(tick)));
  return barGap + barWidth + 20 + Math.max(24, ...ticks) + lineHeight * wrapped(label, height).length;
}

const barWidth = 14,
  barGap = 16;

// label: of the quantity; range: of the numbers shown; state: {scale, colours, isWhole}.
export function colourBar(canvas, label, range, state) {
  return (index, scales, values, dimensions, { document }) => {
    const left = dimensions.width - dimensions.marginRight + barGap,
      top = dimensions.marginTop;
    const height = dimensions.height - top - dimensions.marginBottom;
    const bar = new Uint8ClampedArray(4 * 256),
      table = colourTable(state.colours ?? "viridis");
    for (let row = 0; row < 256; ++row) {
      const step = 4 * Math.round(((255 - row) / 255) * (colourSteps - 1));
      bar.set(table.subarray(step, step + 4), 4 * row);
    }
    const group = svgElement(document, "g", {
      "aria-label": "colour scale",
      fill: "currentColor",
      "text-anchor": "start",
    });
    group.appendChild(
      svgElement(document, "image", {
        x: left,
        y: top,
        width: barWidth,
        height,
        preserveAspectRatio: "none",
        href: canvas.image(1, 256, bar),
      }),
    );
    group.appendChild(
      svgElement(document, "rect", {
        x: left,
        y: top,
        width: barWidth,
        height,
        fill: "none",
        stroke: "currentColor",
      }),
    );
    const scale = Plot.scale({
      y: { type: state.scale === "log" ? "log" : "linear", domain: range, range: [top + height, top] },
    });
    const ticks = tickValues(range, state.scale, Math.max(2, Math.round(height / 45)), state.isWhole);
    for (const tick of ticks) {
      const y = scale.apply(tick);
      group.appendChild(
        svgElement(document, "path", { d: `M${left + barWidth},${y}h4`, stroke: "currentColor" }),
      );
      group.appendChild(
        svgElement(document, "text", { x: left + barWidth + 7, y, dy: "0.32em" }, numberText(tick)),
      );
    }
    const lines = wrapped(label, height);
    lines.forEach((line, n) => {
      const right = dimensions.width - 8 - lineHeight * (lines.length - 1 - n);
      const transform = `translate(${right},${top + height / 2}) rotate(-90)`;
      group.appendChild(svgElement(document, "text", { transform, "text-anchor": "middle" }, line));
    });
    return group;
  };
}

function tickValues([low, high], scale, count, isWhole) {
  if (scale !== "log") {
    const step = Math.max(niceStep((high - low) / count), isWhole ? 1 : 0);
    const ticks = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high * (1 + 1e-12) + step * 1e-9; ++k)
      ticks.push(k * step);
    return ticks;
  }
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power) {
    for (const digit of Math.log10(high / low) > 2 ? [1] : [1, 2, 5]) ticks.push(digit * 10 ** power);
  }
  return ticks.filter((tick) => tick >= low * (1 - 1e-12) && tick <= high * (1 + 1e-12));
}

function niceStep(rough) {
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((digit) => digit * power).find((step) => step >= rough * (1 - 1e-12));
}
