// Colours of maps: perceptually uniform, readable by the colour-blind.
import { interpolateCividis, interpolateViridis, rgb } from "d3";
import { regimeColours } from "./frame.js";

export const colourMaps = { viridis: interpolateViridis, cividis: interpolateCividis };
export const missingColour = [160, 160, 160, 90]; // translucent grey: there is no number

const steps = 512;

// 512 colours from low to high.
export function colourTable(name) {
  const table = new Uint8ClampedArray(4 * steps);
  for (let i = 0; i < steps; ++i) {
    const { r, g, b } = rgb(colourMaps[name](i / (steps - 1)));
    table.set([r, g, b, 255], 4 * i);
  }
  return table;
}

export const colourSteps = steps;

const statusColours = {
  ok: "#DDE3E8",
  grazing: "#E69F00",
  unbounded: "#6F4E9B",
  failed: "#D55E00",
  several: "#0072B2",
  not_periodic: "#CC79A7",
};
const others = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#8C6D31", "#D55E00", "#6F4E9B"];

// Meaning -> colour of a flag's values; not_computed has none.
export function flagColours(variable) {
  const known = { ...regimeColours, ...statusColours };
  return new Map(
    variable.flags
      .filter(([, word]) => word !== "not_computed")
      .map(([value, word], i) => [value, { word, colour: known[word] ?? others[i % others.length] }]),
  );
}
