// Figures over the height of a structure: the largest displacement of each mass, the stroke of the springs between
// neighbours, and the mode shapes.
import * as Plot from "@observablehq/plot";
import { ticks } from "d3";
import {
  driftPath,
  pointNames,
  profileColumns,
  profileDrifts,
  profileModes,
  profilePeaks,
} from "../profile.js";
import { numberText, unitText, withUnit, words } from "../units.js";
import { curve, dots, drawFrame, grid, lineColours, tips } from "./frame.js";
import { lineFigure, style } from "./line_figure.js";

const upright = 1; // height of a figure over its width
const manyDots = 40; // masses whose dots are small

function heightLabel({ masses, unit }) {
  return unit ? "height" : `mass, from 1 (${words(masses[0])}) to ${masses.length} (${words(masses.at(-1))})`;
}

const mostTicks = 10;

// Where masses are only numbered, ticks are whole numbers.
function heightTicks({ heights, unit }) {
  const places = ticks(Math.min(0, heights[0]), heights.at(-1), mostTicks);
  return unit ? places : places.filter(Number.isInteger);
}

function heightAxis(profile) {
  const numbered = profile.unit ? {} : { ticks: heightTicks(profile) };
  return { label: heightLabel(profile), unit: profile.unit ?? "1", zero: true, ...numbered };
}

function caption(map, points, hint, shown, all, what) {
  const place = points.length === 1 ? pointNames(map, points)[0] : "";
  const some = shown < all ? `${shown} of ${all} ${what} are recorded` : "";
  return [place, some, hint].filter(Boolean).join("; ");
}

// One curve for each point, named in the legend if there are several.
function curvesOf(map, points, pathOf) {
  const names = pointNames(map, points);
  return points.map((index, n) => ({
    name: names[n] || "value",
    text: points.length > 1 ? names[n] : "",
    path: true,
    ...pathOf(index),
    ...style(n),
  }));
}

// spec(): that of a lineFigure; it follows the points, which may change.
function following({ name, title, spec, table, note }) {
  return {
    name,
    title,
    ratio: upright,
    get caption() {
      return note();
    },
    draw: (canvas) => lineFigure({ name, title, ...spec() }).draw(canvas),
    table,
  };
}

// The largest displacement of each mass over the height.  pointsOf(): indices of the map.  null if the map has too few.
export function peakProfile(map, profile, pointsOf) {
  const peaks = profilePeaks(map, profile);
  if (peaks.length < 2 || 2 * peaks.length < profile.masses.length) return null;
  const heights = peaks.map(({ height }) => height);
  const pathOf = (index) => ({ x: peaks.map(({ variable }) => map.value(variable, index)), y: heights });
  return following({
    name: "profile_peak",
    title: "Largest displacements over the height",
    note: () => caption(map, pointsOf(), profile.hint, peaks.length, profile.masses.length, "masses"),
    spec: () => {
      const lines = curvesOf(map, pointsOf(), pathOf);
      return {
        x: { label: "largest displacement", unit: peaks[0].variable.unit, zero: true },
        y: heightAxis(profile),
        lines,
        points: lines.map(({ x, y, stroke }) => ({
          x,
          y,
          stroke,
          silent: true,
          r: peaks.length > manyDots ? 1.4 : 2.6,
        })),
      };
    },
    table: () =>
      profileColumns(map, pointsOf(), "peak", peaks, [
        { name: "mass", unit: "", values: peaks.map(({ mass }) => mass) },
        { name: "height", unit: profile.unit ?? "1", values: heights },
      ]),
  });
}

// The strokes of the springs between neighbours.  null if the map has too few.
export function driftProfile(map, profile, pointsOf) {
  const drifts = profileDrifts(map, profile),
    joined = profile.springs.filter(Boolean).length;
  if (!drifts.length || 2 * drifts.length < joined) return null;
  return following({
    name: "profile_drift",
    title: "Strokes between neighbours over the height",
    note: () => caption(map, pointsOf(), profile.hint, drifts.length, joined, "springs"),
    spec: () => ({
      x: { label: "stroke of the spring", unit: drifts[0].variable.unit, zero: true },
      y: heightAxis(profile),
      lines: curvesOf(map, pointsOf(), (index) => driftPath(map, drifts, index)),
    }),
    table: () =>
      profileColumns(map, pointsOf(), "stroke", drifts, [
        { name: "spring", unit: "", values: drifts.map(({ spring }) => spring) },
        { name: "from_height", unit: profile.unit ?? "1", values: drifts.map(({ below }) => below) },
        { name: "to_height", unit: profile.unit ?? "1", values: drifts.map(({ above }) => above) },
      ]),
  });
}

const laneHalf = 0.42; // half the width of a mode's lane; lanes are 1 apart

// A lane for each mode: its zero, its shape, from the base where a spring holds the lowest mass there, and above it
// frequency and damping.
function laneMarks({ mode, frequency, damping, shape }, { heights, springs }, [low, high, top]) {
  const x = shape.map((value) => mode + laneHalf * value),
    stroke = lineColours[(mode - 1) % lineColours.length];
  const text = [numberText(frequency, 4), frequency > 0 ? `${numberText(100 * damping, 3)} %` : "free"].join(
    "\n",
  );
  const held = springs[0] && heights[0] > 0;
  return [
    Plot.ruleX([mode], {
      y1: low,
      y2: high,
      stroke: "currentColor",
      strokeOpacity: 0.5,
      strokeDasharray: "3 3",
    }),
    curve(held ? [mode, ...x] : x, held ? [0, ...heights] : heights, { stroke }),
    dots(x, heights, { fill: stroke, r: heights.length > manyDots ? 1.2 : 2.2 }),
    Plot.text([[mode, top]], { text: () => text, lineAnchor: "top", lineHeight: 1.25, dy: 5 }),
  ];
}

function modeTips(modes, profile) {
  return modes.flatMap(({ mode, shape }) =>
    shape.map((value, i) => ({
      x: mode + laneHalf * value,
      y: profile.heights[i],
      text: `mode ${mode}\n${words(profile.masses[i])}: ${numberText(value, 4)}`,
    })),
  );
}

const leastLane = 58, // pixels, for the numbers above it
  besideLanes = 90;

// The first modes side by side, as many as there is room for.
function drawModes(canvas, modes, profile, unit) {
  const room = Math.floor((canvas.width - besideLanes) / leastLane);
  const shown = modes.slice(0, Math.max(1, room));
  const [low, high] = [Math.min(0, profile.heights[0]), profile.heights.at(-1)];
  const top = high + 0.18 * (high - low); // room for two lines of text
  const places = heightTicks(profile);
  return drawFrame(canvas, {
    x: {
      label: `mode, with its frequency${unit ? ` (${unit})` : ""} and damping ratio`,
      domain: [0.5, shown.length + 0.5],
      ticks: shown.map(({ mode }) => mode),
      tickFormat: String,
    },
    y: {
      label: withUnit(heightLabel(profile), unitText(profile.unit)),
      domain: [low, top],
      ticks: places,
    },
    marks: [
      ...grid({ ticks: [] }, { ticks: places }),
      ...shown.flatMap((mode) => laneMarks(mode, profile, [low, high, top])),
      ...tips(canvas, modeTips(shown, profile)),
    ],
  });
}

// group: /modes.
export function modeShapes(group, profile) {
  const modes = profileModes(group, profile);
  return {
    name: "mode_shapes",
    title: "Mode shapes over the height",
    caption: `Undamped modes with all friction sliding, at ${group.texts.point}; above each its frequency and damping ratio${profile.hint && `; ${profile.hint}`}`,
    draw: (canvas) => drawModes(canvas, modes, profile, unitText(group.column("mode_frequency").unit)),
    table: () => [
      { name: "mass", unit: "", values: profile.masses },
      { name: "height", unit: profile.unit ?? "1", values: profile.heights },
      ...modes.map(({ mode, shape }) => ({ name: `mode_${mode}`, unit: "1", values: shape })),
    ],
  };
}
