// The page of branches that were followed without a map.
import { symbolText } from "../axes.js";
import { branchesOf } from "../branches.js";
import { branchFigure, branchTable } from "../figures/branch_figure.js";
import { choice } from "../parts/controls.js";
import { element, section, table } from "../parts/elements.js";
import { figureCard } from "../parts/figure_card.js";
import { numberText, sentence, words } from "../units.js";

const own = ["arclength", "floquet_radius", "residual", "special_residual"];

// The quantities of the points, without what tells of the branch itself.
function quantitiesOf({ along, group }) {
  return group
    .along("place")
    .filter(({ name, kind }) => kind === "float" && name !== along && !own.includes(name));
}

// state: {quantity}; the figure follows it.
function figureOf(followed, state) {
  return {
    get name() {
      return `branches_${state.quantity.name}`;
    },
    get title() {
      return sentence(`${words(state.quantity.name)} along ${symbolText(followed.along)}`);
    },
    caption: "Solid: stable; dashed: unstable.",
    draw: (canvas) => branchFigure(canvas, followed, state.quantity),
    table: () => branchTable(followed, state.quantity),
  };
}

// The special points of all branches, with the numbers of a quantity.
function specialTable(followed, quantity) {
  const { group, x } = followed;
  const kinds = group.words("special"),
    elements = group.words("special_element");
  const rows = kinds
    .map((kind, i) => [kind, i])
    .filter(([kind]) => kind && kind !== "none")
    .map(([kind, i]) => [
      words(kind),
      numberText(x.values[i], 12),
      numberText(quantity.values[i], 12),
      elements[i] === "none" ? "" : elements[i],
    ]);
  if (!rows.length) return element("p", {}, "No special points.");
  return table(["special point", symbolText(followed.along), words(quantity.name), "element"], rows, {
    numeric: [1, 2],
  });
}

export function branchParts(record) {
  const followed = branchesOf(record);
  const quantities = quantitiesOf(followed),
    state = { quantity: quantities[0] };
  const shown = figureCard(figureOf(followed, state), record),
    place = element("div", {}, specialTable(followed, state.quantity));
  const chooser = choice(
    "quantity",
    quantities.map(({ name }) => [name, words(name)]),
    state.quantity.name,
    (name) => {
      state.quantity = followed.group.column(name);
      place.replaceChildren(specialTable(followed, state.quantity));
      shown.redraw();
    },
  );
  return [
    section("Branches", element("div", { class: "controls" }, chooser), shown.card),
    section("Special points", place),
  ];
}

const mostFigures = 6;

export function branchFigures(record) {
  const followed = branchesOf(record);
  return quantitiesOf(followed)
    .slice(0, mostFigures)
    .map((quantity) => figureOf(followed, { quantity }));
}
