// The figures of a map as it is looked at (see sweep_state.js): cells over two axes, curves along one, damping budget.
import { axisText, symbolText } from "../axes.js";
import { energyShares, energySharesTable } from "../figures/energy_shares.js";
import { responseCurves, responseCurvesTable } from "../figures/response_curves.js";
import { responseMap, responseMapTable, valueAt } from "../figures/response_map.js";
import { sentence, words } from "../units.js";
import { curvePoints } from "./sweep_state.js";

// Where the point of the sliders stands on all axes but those left out.
function placeWithout(map, state, leftOut) {
  return map.axes
    .map((axis, a) => (leftOut.includes(a) || axis.size < 2 ? "" : axisText(map, axis, state.index[a])))
    .filter(Boolean)
    .join(", ");
}

const gaps = new WeakMap(); // variable -> whether points of it are missing

function hasGaps(variable) {
  const none = variable.kind === "count" ? -1 : variable.kind === "flag" ? 0 : NaN;
  if (!gaps.has(variable))
    gaps.set(
      variable,
      variable.values.some((value) => Object.is(value, none)),
    );
  return gaps.get(variable);
}

// Whether a crossing lies on the map of the two axes shown.
function isInSlice(place, state) {
  return place.every((at, a) => a === state.x || a === state.y || Math.abs(at - state.index[a]) < 1e-9);
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

export function mapFigure(map, state) {
  const crossings = () => state.crossings.get(state.contact) ?? [];
  return {
    name: () => `map_${state.variable.name}`,
    get title() {
      const what = state.variable.long_name || words(state.variable.name);
      return sentence([what, placeWithout(map, state, [state.x, state.y])].filter(Boolean).join("; "));
    },
    get caption() {
      const grey = hasGaps(state.variable) ? "Grey: no number. " : "";
      const borders = `Lines: borders between the regimes of ${words(state.contact)}, solved, not sampled.`;
      const drawn = crossings().some(({ place }) => isInSlice(place, state));
      return grey + (drawn ? borders : "");
    },
    draw: (canvas) =>
      responseMap(canvas, map, state.variable, {
        ...state,
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
    name: () => `curves_${state.variable.name}`,
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

// shares: the variables <e>_energy_share that are not all zero.
export function budgetFigure(map, state, shares) {
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
