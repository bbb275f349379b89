// The figures of a map as it is looked at (see sweep_state.js): cells over two axes, curves along one, damping budget.
import { axisText, symbolText } from "../axes.js";
import { crossingsOfSlice } from "../borders.js";
import { dissipating, energyShares, energySharesTable } from "../figures/energy_shares.js";
import { responseCurves, responseCurvesTable } from "../figures/response_curves.js";
import { responseMap, responseMapTable, valueAt } from "../figures/response_map.js";
import { isMissing } from "../record.js";
import { sentence, words } from "../units.js";
import { curvePoints, sliding } from "./sweep_state.js";

// Where the point of the sliders stands on all axes but those left out.
function placeWithout(map, state, leftOut) {
  return map.axes
    .map((axis, a) => (leftOut.includes(a) || axis.size < 2 ? "" : axisText(map, axis, state.index[a])))
    .filter(Boolean)
    .join(", ");
}

const gaps = new WeakMap(); // variable -> whether points of it are missing

function hasGaps(variable) {
  if (!gaps.has(variable))
    gaps.set(
      variable,
      variable.values.some((value) => isMissing(variable, value)),
    );
  return gaps.get(variable);
}

// Where borders cross the line of the curves through the sliders' point: coordinates along it.
function bordersAlong(map, state) {
  const { values } = map.axes[state.curveAxis].coordinates[state.coordinates[state.curveAxis]];
  return (state.crossings.get(state.contact) ?? [])
    .filter(
      ({ axis, place }) =>
        axis === state.curveAxis && place.every((at, a) => a === axis || at === state.index[a]),
    )
    .map(({ place }) => valueAt(values, place[state.curveAxis]));
}

// Colours go by powers of ten where the largest value is far above most.
const farAbove = 8;
const sampled = 10_000; // values are enough to tell
function suitedScale({ kind, values }) {
  if (kind !== "float") return "linear";
  const step = Math.ceil(values.length / sampled);
  const some = Float64Array.from({ length: Math.floor(values.length / step) }, (_, i) => values[i * step]);
  const sorted = some.filter(Number.isFinite).sort();
  return sorted[0] >= 0 && sorted.at(-1) > farAbove * sorted[sorted.length >> 1] ? "log" : "linear";
}

export function mapFigure(map, state) {
  const crossings = () => state.crossings.get(state.contact) ?? [];
  return {
    get name() {
      return `map_${state.variable.name}`;
    },
    get title() {
      const what = state.variable.long_name || words(state.variable.name);
      return sentence([what, placeWithout(map, state, [state.x, state.y])].filter(Boolean).join("; "));
    },
    get caption() {
      const grey = hasGaps(state.variable) ? "Grey: no number. " : "";
      const borders = `Lines: borders between the regimes of ${words(state.contact)}, solved, not sampled.`;
      const drawn = crossingsOfSlice(crossings(), state).length > 0;
      return grey + (drawn ? borders : "");
    },
    draw: (canvas) =>
      responseMap(canvas, map, state.variable, {
        ...state,
        scale: state.scale === "automatic" ? suitedScale(state.variable) : state.scale,
        crossings: crossings(),
        picked: canvas.interactive ? curvePoints(state) : [],
      }),
    table: () => responseMapTable(map, state.variable, state),
  };
}

export function regimeOf(map, contact) {
  return map.variable(`${contact}_regime`);
}

export function curveFigure(map, state) {
  const curves = () => ({
    axis: state.curveAxis,
    coordinate: state.coordinates[state.curveAxis],
    scale: state.curveScale,
    points: curvePoints(state),
    borders: bordersAlong(map, state),
    regime: state.colourByRegime ? regimeOf(map, state.contact) : undefined,
  });
  return {
    get name() {
      return `curves_${state.variable.name}`;
    },
    get title() {
      const along = map.axes[state.curveAxis].coordinates[state.coordinates[state.curveAxis]];
      return sentence(`${words(state.variable.name)} along ${symbolText(along.name)}`);
    },
    get caption() {
      const points = curvePoints(state);
      const shared = map.axes
        .map((_, a) => a)
        .filter((a) => points.every((index) => index[a] === points[0][a]));
      const differing = map.axes.map((_, a) => a).filter((a) => !shared.includes(a));
      const dashed = points.length === 1 && bordersAlong(map, state).length;
      const rules = dashed ? `; upright lines: where the regime of ${words(state.contact)} changes` : "";
      return placeWithout(map, { ...state, index: points[0] }, [state.curveAxis, ...differing]) + rules;
    },
    draw: (canvas) => responseCurves(canvas, map, state.variable, curves()),
    table: () => responseCurvesTable(map, state.variable, curves()),
  };
}

// null where nothing was recorded of it.
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
    title: "Damping budget: who dissipates",
    caption: "Along the axis of the curves, through the point of the sliders.",
    draw: (canvas) => energyShares(canvas, map, shares, along()),
    table: () => energySharesTable(map, shares, along()),
  };
}

// Points for curves: through the state's, at the ends and in the middle of the map's second axis.
function pointsAcross(map, state) {
  if (state.y === null) return [state.index];
  const last = map.axes[state.y].size - 1;
  return [...new Set([0, Math.round(last / 2), last])].map((i) =>
    state.index.map((k, a) => (a === state.y ? i : k)),
  );
}

// For papers: the map of each quantity in the middle of the other axes, curves of each number, the damping budget.
export function allMapFigures(map, state) {
  const kept = pointsAcross(map, state);
  const figures = map.variables.flatMap((variable) => {
    const seen = { ...state, variable };
    return [
      state.y === null ? null : mapFigure(map, seen),
      variable.kind === "float" ? curveFigure(map, { ...seen, kept, index: kept[0] }) : null,
    ];
  });
  return [...figures, budgetFigure(map, state)].filter(Boolean);
}
