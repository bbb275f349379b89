// The figures of a map as it is looked at (see sweep_state.js): cells over two axes, curves along one, damping budget.
import { coordinateText, symbolText } from "../axes.js";
import { energyShares, energySharesTable } from "../figures/energy_shares.js";
import { responseCurves, responseCurvesTable } from "../figures/response_curves.js";
import { responseMap, responseMapTable } from "../figures/response_map.js";
import { sentence, words } from "../units.js";
import { curvePoints } from "./sweep_state.js";

// Where the point of the sliders stands on all axes but those left out.
function placeWithout(map, state, leftOut) {
  return map.axes
    .map((axis, a) =>
      leftOut.includes(a) || axis.size < 2 ? "" : coordinateText(axis.coordinates[0], state.index[a]),
    )
    .filter(Boolean)
    .join(", ");
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
      const borders = `Lines: borders between the regimes of ${words(state.contact)}, solved, not sampled.`;
      return `Grey: no number. ${crossings().length ? borders : ""}`.trim();
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
    regime: state.colourByRegime ? regimeOf(map, state.contact) : undefined,
  });
  return {
    name: () => `curves_${state.variable.name}`,
    get title() {
      const along = map.axes[state.curveAxis].coordinates[state.coordinates[state.curveAxis]];
      return sentence(`${words(state.variable.name)} along ${symbolText(along.name)}`);
    },
    get caption() {
      return curvePoints(state).length > 1 ? "" : placeWithout(map, state, [state.curveAxis]);
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
