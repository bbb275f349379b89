// The interactive map: lists and sliders choose what is shown, a click on the map picks a point for the curves.
import { coordinateLabel } from "../axes.js";
import { choice, choiceOfMany, slider, tick } from "../parts/controls.js";
import { element, section } from "../parts/elements.js";
import { figureCard } from "../parts/figure_card.js";
import { followPointer } from "../parts/map_pointer.js";
import { pointCard, pointTip } from "../parts/point_table.js";
import { mostListed } from "../profile.js";
import { budgetFigure, curveFigure, hasBranches, mapFigure, regimeOf } from "./map_figures.js";
import { profileFigures } from "./profile.js";
import { recordsFigure, recordsTable } from "./records.js";
import { curvePoints, firstState, listedQuantities, profilePoints, sliding } from "./sweep_state.js";

const scales = [
  ["linear", "linear"],
  ["log", "logarithmic"],
];

// All parts of the explorer: the record, its state, its figures, the containers of its controls.
function viewOf(record) {
  const { map } = record,
    state = firstState(record);
  const card = (figure) => figure && figureCard(figure, record);
  return {
    record,
    map,
    state,
    wide: sliding(map),
    mapShown: state.y === null ? null : card(mapFigure(map, state)),
    curvesShown: card(curveFigure(map, state)),
    recordsShown: card(recordsFigure(map, state)),
    budgetShown: card(budgetFigure(map, state)),
    profilesShown: profileFigures(record, () => profilePoints(state)).map(card),
    mapControls: element("div", { class: "controls" }),
    sliders: element("div", { class: "controls" }),
    curveControls: element("div", { class: "controls" }),
    place: element("div", {}),
    rows: [],
    waiting: false,
  };
}

// Redraws once at the next frame, however often it is called before.
function redraw(view) {
  if (view.waiting) return;
  view.waiting = true;
  requestAnimationFrame(() => {
    view.waiting = false;
    const { mapShown, curvesShown, recordsShown, budgetShown, profilesShown } = view;
    for (const shown of [mapShown, curvesShown, recordsShown, budgetShown, ...profilesShown]) shown?.redraw();
    const { record, map, state } = view,
      listed = listedQuantities(state);
    view.place.replaceChildren(
      ...[recordsTable(map, state, listed), pointCard(record, state.index, listed)].filter(Boolean),
    );
  });
}

// Changes the state and shows it.
function change(view, changes) {
  Object.assign(view.state, changes);
  redraw(view);
}

// The monotone coordinates of the axes as [axis:coordinate, label].
function coordinateChoices({ map, wide }) {
  return wide
    .flatMap((axis) => map.axes[axis].coordinates.map((coordinate, c) => [`${axis}:${c}`, coordinate]))
    .filter(([, { monotone }]) => monotone)
    .map(([key, coordinate]) => [key, coordinateLabel(coordinate)]);
}

function chosenCoordinate(state, key) {
  const [axis, coordinate] = key.split(":").map(Number);
  state.coordinates[axis] = coordinate;
  return axis;
}

// Sets the horizontal or vertical axis; swaps the two if the other has the chosen axis.
function setAxis(view, which, key) {
  const { state } = view,
    other = which === "x" ? "y" : "x";
  const axis = chosenCoordinate(state, key);
  if (axis === state[other]) [state.x, state.y] = [state.y, state.x];
  else state[which] = axis;
  arrange(view);
}

// The names of many contacts that are listed: the first, the last and the one that is shown.
function listedContacts(names, shown) {
  if (names.length <= mostListed) return names;
  return names.filter((name, i) => i === 0 || i === names.length - 1 || name === shown);
}

// A quantity that was not listed is listed from now on.
function chooseQuantity(view, name) {
  const variable = view.map.variable(name);
  if (listedQuantities(view.state).includes(variable)) return change(view, { variable });
  view.state.variable = variable;
  return arrange(view);
}

function controlsOfMap(view) {
  const { map, state } = view;
  const quantity = choiceOfMany(
    "quantity",
    map.variables.map(({ name }) => name),
    listedQuantities(state).map(({ name }) => name),
    state.variable.name,
    (name) => chooseQuantity(view, name),
  );
  if (state.y === null) return quantity;
  const axis = (label, which) =>
    choice(label, coordinateChoices(view), `${state[which]}:${state.coordinates[state[which]]}`, (key) =>
      setAxis(view, which, key),
    );
  const contacts = [...state.crossings.keys()];
  return [
    ...quantity,
    axis("across", "x"),
    axis("up", "y"),
    choice("colours", [["automatic", "automatic"], ...scales], state.scale, (scale) =>
      change(view, { scale }),
    ),
    choice(
      "palette",
      [
        ["viridis", "viridis"],
        ["cividis", "cividis"],
      ],
      state.colours,
      (colours) => change(view, { colours }),
    ),
    ...(contacts.length
      ? choiceOfMany(
          "contact",
          contacts,
          listedContacts(contacts, state.contact),
          state.contact,
          (contact) => {
            state.contact = contact;
            arrange(view);
          },
        )
      : []),
  ];
}

function controlsOfCurves(view) {
  const { map, state, wide } = view;
  const button = (id, text, kept) =>
    element("button", { type: "button", id, onclick: () => change(view, { kept: kept() }) }, text);
  return [
    wide.length &&
      choice(
        "along",
        coordinateChoices(view),
        `${state.curveAxis}:${state.coordinates[state.curveAxis]}`,
        (key) => {
          state.curveAxis = chosenCoordinate(state, key);
          arrange(view);
        },
      ),
    choice("scale", [...scales, ["dB", "dB"]], state.curveScale, (curveScale) =>
      change(view, { curveScale }),
    ),
    regimeOf(map, state.contact)
      ? tick("colour by regime", state.colourByRegime, (colourByRegime) => change(view, { colourByRegime }))
      : null,
    hasBranches(map, state)
      ? tick("branches", state.showBranches, (showBranches) => change(view, { showBranches }))
      : null,
    wide.length > 1 ? button("keep", "keep this curve", () => [...curvePoints(state)]) : null,
    wide.length > 1 ? button("clear", "clear kept", () => []) : null,
  ];
}

// A slider for every axis that the map does not show.
function slidersOf(view) {
  const { map, state, wide } = view;
  const hidden = wide.filter((axis) => state.y === null || (axis !== state.x && axis !== state.y));
  return hidden.map((axis) =>
    slider(
      map.axes[axis],
      () => state.index[axis],
      (to) => change(view, { index: state.index.map((i, a) => (a === axis ? to : i)) }),
    ),
  );
}

// Rebuilds the controls, which depend on what is shown.
function arrange(view) {
  view.mapControls.replaceChildren(...controlsOfMap(view).filter(Boolean));
  view.curveControls.replaceChildren(...controlsOfCurves(view).filter(Boolean));
  view.rows = slidersOf(view);
  view.sliders.replaceChildren(...view.rows.map(({ row }) => row));
  redraw(view);
}

function pick(view, index, keep) {
  const { state } = view;
  change(view, { kept: keep ? curvePoints(state) : state.kept, index });
  view.rows.forEach(({ refresh }) => refresh());
}

export function explorerSections(record) {
  const view = viewOf(record);
  const { mapShown, curvesShown, recordsShown, budgetShown, profilesShown } = view;
  arrange(view);
  if (mapShown) {
    followPointer(
      mapShown,
      view.map,
      view.state,
      (index) => pointTip(record, index, view.state.variable, listedQuantities(view.state)),
      (index, keep) => pick(view, index, keep),
    );
  }
  const hint =
    "Point at the map to read it; click or tap to select a point for the curves (with Shift to keep the previous one), " +
    "or move it with the arrow keys.";
  return [
    section(
      mapShown ? "Response map" : "Response",
      view.mapControls,
      view.sliders,
      mapShown?.card,
      mapShown ? element("p", { class: "note hint" }, hint) : null,
    ),
    section("Response curves", view.curveControls, curvesShown.card, recordsShown?.card, budgetShown?.card),
    profilesShown.length
      ? section(
          "Over the height",
          element("div", { class: "cards" }, ...profilesShown.map(({ card }) => card)),
        )
      : null,
    section("Point", view.place),
  ].filter(Boolean);
}
