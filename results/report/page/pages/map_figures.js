// The figures of a map as viewed (see sweep_state.js): cells over two axes, curves along one, damping budget.
import { axisText, symbolText } from "../axes.js";
import { crossingsOfSlice } from "../borders.js";
import { dissipating, energyShares, energySharesTable } from "../figures/energy_shares.js";
import { responseCurves, responseCurvesTable } from "../figures/response_curves.js";
import { leastOfLogarithm, responseMap, responseMapTable, valueAt } from "../figures/response_map.js";
import { numberText, sentence, words } from "../units.js";
import { spansDecades, suitsLogarithm, valueRange } from "../value_range.js";
import { recordsFigure } from "./records.js";
import { curvePoints, shownContact, sliding } from "./sweep_state.js";

// The sliders' point as text, on all axes but those left out.
function placeWithout(map, state, leftOut) {
  return map.axes
    .map((axis, a) => (leftOut.includes(a) || axis.size < 2 ? "" : axisText(map, axis, state.index[a])))
    .filter(Boolean)
    .join(", ");
}

// Where borders cross the line of the curves through the sliders' point: coordinates along it.
function bordersAlong(map, state) {
  const { values } = map.axes[state.curveAxis].coordinates[state.coordinates[state.curveAxis]];
  return (state.crossings.get(shownContact(state)) ?? [])
    .filter(
      ({ axis, place }) =>
        axis === state.curveAxis && place.every((at, a) => a === axis || at === state.index[a]),
    )
    .map(({ place }) => valueAt(values, place[state.curveAxis]));
}

// Logarithmic if chosen, or automatically if it shows more; only where it is meaningful.
function colourScaleOf({ variable, scale }) {
  const wanted = scale === "automatic" ? spansDecades(variable) : scale === "log";
  return wanted && suitsLogarithm(variable) ? "log" : "linear";
}

function mapNotes({ variable, scale }, hasBorders, contact) {
  const { low, high, hasGaps } = valueRange(variable);
  const isFloat = variable.kind === "float";
  return [
    hasGaps ? "Grey: no value." : "",
    isFloat && low === high ? `${numberText(low)} everywhere.` : "",
    isFloat && scale === "log" && low < leastOfLogarithm(variable)
      ? "Values below the scale, including zero, have its lowest colour."
      : "",
    hasBorders ? `Lines: borders between the regimes of ${words(contact)}, solved, not sampled.` : "",
  ];
}

export function mapFigure(map, state) {
  const crossings = () => state.crossings.get(shownContact(state)) ?? [];
  return {
    get name() {
      return `map_${state.variable.name}`;
    },
    get title() {
      const what = state.variable.long_name || words(state.variable.name);
      return sentence([what, placeWithout(map, state, [state.x, state.y])].filter(Boolean).join("; "));
    },
    get caption() {
      const hasBorders = crossingsOfSlice(crossings(), state).length > 0;
      const shown = { variable: state.variable, scale: colourScaleOf(state) };
      return mapNotes(shown, hasBorders, shownContact(state)).filter(Boolean).join(" ");
    },
    draw: (canvas) =>
      responseMap(canvas, map, state.variable, {
        ...state,
        scale: colourScaleOf(state),
        crossings: crossings(),
        picked: canvas.interactive ? curvePoints(state) : [],
      }),
    table: () => responseMapTable(map, state.variable, state),
  };
}

export function regimeOf(map, contact) {
  return map.variable(`${contact}_regime`);
}

// Whether branches go along the curves.
export function hasBranches(map, { followed, curveAxis }) {
  return followed !== null && map.axes[curveAxis].coordinates.some(({ name }) => name === followed.along);
}

function branchNote(map, state) {
  const isDrawn =
    state.showBranches && hasBranches(map, state) && state.followed.group.has(state.variable.name);
  return isDrawn ? "branches over the map's own curve: stable solid, unstable dashed" : "";
}

export function curveFigure(map, state) {
  const curves = () => ({
    axis: state.curveAxis,
    coordinate: state.coordinates[state.curveAxis],
    scale: suitsLogarithm(state.variable) ? state.curveScale : "linear",
    points: curvePoints(state),
    borders: bordersAlong(map, state),
    regime: state.colourByRegime ? regimeOf(map, shownContact(state)) : undefined,
    followed: state.showBranches ? state.followed : null,
  });
  return {
    get name() {
      return `curves_${state.variable.name}`;
    },
    get title() {
      const along = map.axes[state.curveAxis].coordinates[state.coordinates[state.curveAxis]];
      return `${words(state.variable.name)} along ${symbolText(along.name)}`;
    },
    get caption() {
      const points = curvePoints(state);
      const shared = map.axes
        .map((_, a) => a)
        .filter((a) => points.every((index) => index[a] === points[0][a]));
      const differing = map.axes.map((_, a) => a).filter((a) => !shared.includes(a));
      const dashed = points.length === 1 && bordersAlong(map, state).length;
      const rules = dashed
        ? `; upright lines: where the regime of ${words(shownContact(state))} changes`
        : "";
      const place =
        placeWithout(map, { ...state, index: points[0] }, [state.curveAxis, ...differing]) + rules;
      return [place, branchNote(map, state)].filter(Boolean).join("; ");
    },
    draw: (canvas) => responseCurves(canvas, map, state.variable, curves()),
    table: () => responseCurvesTable(map, state.variable, curves()),
  };
}

// null if no energy share is recorded.
export function budgetFigure(map, state) {
  const shares = dissipating(map.variables);
  if (shares.length === 0 || sliding(map).length === 0) return null;
  const along = () => ({
    axis: state.curveAxis,
    coordinate: state.coordinates[state.curveAxis],
    index: state.index,
  });
  return {
    name: "damping_budget",
    title: "Damping budget: which element dissipates",
    get caption() {
      const place = placeWithout(map, state, [state.curveAxis]);
      return [place, "blank where nothing is dissipated"].filter(Boolean).join("; ");
    },
    draw: (canvas) => energyShares(canvas, map, shares, along()),
    table: () => energySharesTable(map, shares, along()),
  };
}

// Points for curves: through the state's, at the ends and in the middle of the map's second axis.
export function pointsAcross(map, state) {
  if (state.y === null) return [state.index];
  const last = map.axes[state.y].size - 1;
  return [...new Set([0, Math.round(last / 2), last])].map((i) =>
    state.index.map((k, a) => (a === state.y ? i : k)),
  );
}

// For papers: the map of each listed quantity in the middle of the other axes, curves of each number, the damping
// budget.
export function allMapFigures(map, state) {
  const kept = pointsAcross(map, state);
  const figures = state.headlines.flatMap((variable) => {
    const seen = { ...state, variable };
    return [
      state.y === null ? null : mapFigure(map, seen),
      variable.kind === "float" ? curveFigure(map, { ...seen, kept, index: kept[0] }) : null,
      variable.kind === "float" ? recordsFigure(map, seen) : null,
    ];
  });
  return [...figures, budgetFigure(map, state)].filter(Boolean);
}
