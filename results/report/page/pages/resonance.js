// The resonances solved along the frequency axis: over a parameter of the map, or as numbers.
import {
  curveNumbers,
  firstParameter,
  resonanceFigure,
  resonanceNote,
  resonanceParameters,
  resonanceQuantities,
  resonanceTable,
} from "../figures/resonance_figure.js";
import { choice } from "../parts/controls.js";
import { element, section, table } from "../parts/elements.js";
import { figureCard } from "../parts/figure_card.js";
import { sentence, unitText, words } from "../units.js";

// state: {quantity, x}, columns of the group; the figure follows them.
function figureOf(group, state) {
  return {
    get name() {
      return state.quantity.name;
    },
    get title() {
      return sentence(state.quantity.long_name || words(state.quantity.name));
    },
    get caption() {
      return resonanceNote(group, state.quantity, state.x);
    },
    draw: (canvas) => resonanceFigure(canvas, group, state.quantity, state.x),
    table: () => resonanceTable(group),
  };
}

// The table for a map whose only axis is the frequency.
function resonanceNumbers(group) {
  const rows = resonanceQuantities(group).map(({ name, unit, values }) => [
    words(name),
    String(Number(values[0].toPrecision(8))),
    unitText(unit),
  ]);
  return table(["", "value", "unit"], rows, { numeric: [1] });
}

function resonanceExplorer(record, group) {
  const state = { quantity: resonanceQuantities(group)[0], x: firstParameter(group) };
  const shown = figureCard(figureOf(group, state), record);
  const chooser = (label, columns, key) =>
    choice(
      label,
      columns.map(({ name }) => [name, words(name)]),
      state[key].name,
      (name) => {
        state[key] = columns.find((column) => column.name === name);
        shown.redraw();
      },
    );
  const controls = element(
    "div",
    { class: "controls" },
    chooser("quantity", resonanceQuantities(group), "quantity"),
    chooser("over", [...resonanceParameters(group), curveNumbers(group)], "x"),
  );
  return [controls, shown.card];
}

// null if no resonance was solved.
export function resonanceSection(record) {
  const group = record.groups.get("resonance");
  if (!group?.along("curve").length) return null;
  const shown = resonanceParameters(group).length
    ? resonanceExplorer(record, group)
    : [resonanceNumbers(group)];
  return section("Resonance", ...shown);
}

// One figure for each quantity, over the first parameter.
export function resonanceFigures(record) {
  const group = record.groups.get("resonance");
  if (!group || !resonanceParameters(group).length) return [];
  const x = firstParameter(group);
  return resonanceQuantities(group).map((quantity) => figureOf(group, { quantity, x }));
}
