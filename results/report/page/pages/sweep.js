// The page of a map: heat map with sliders and regime borders, response curves, the picked point, kept orbits,
// resonances, what is missing.
import { coordinateLabel, coordinateText, symbolText } from "../axes.js";
import { dissipating, energyShares, energySharesTable } from "../figures/energy_shares.js";
import { orbitFigures, orbitLabel, orbitSamples } from "../figures/orbit_figures.js";
import { curveNumbers, firstParameter, resonanceFigure, resonanceParameters, resonanceQuantities, resonanceTable } from "../figures/resonance_figure.js";
import { responseCurves, responseCurvesTable } from "../figures/response_curves.js";
import { responseMap, responseMapTable } from "../figures/response_map.js";
import { choice, element, section, table } from "../parts/elements.js";
import { figureCard } from "../parts/figure_card.js";
import { about } from "../parts/heading.js";
import { followPointer } from "../parts/map_pointer.js";
import { pointCard, pointTip } from "../parts/point_table.js";
import { meaningOf } from "../record.js";
import { sentence, unitText, words } from "../units.js";
import { crossingsOf, contactsOf, curvePoints, firstState } from "./sweep_state.js";

const regimeOf = (map, contact) => map.variable(`${contact}_regime`);

function mapFigure(map, state) {
  const shown = () => ({ ...state, crossings: state.crossings.get(state.contact) ?? [], picked: state.y === null ? [] : curvePoints(state) });
  const slice = () => map.axes.map((axis, a) => (a === state.x || a === state.y || axis.size < 2 ? "" : coordinateText(axis.coordinates[0], state.index[a]))).filter(Boolean).join(", ");
  return {
    name: () => `map_${state.variable.name}`,
    get title() { return sentence([state.variable.long_name || words(state.variable.name), slice()].filter(Boolean).join("; ")); },
    get caption() {
      const borders = (state.crossings.get(state.contact) ?? []).length;
      return `Grey: no number.${borders ? ` Lines: borders between the regimes of ${words(state.contact)}, solved, not sampled.` : ""}`;
    },
    draw: (canvas) => responseMap(canvas, map, state.variable, { ...shown(), picked: canvas.interactive ? shown().picked : [] }),
    table: () => responseMapTable(map, state.variable, state),
  };
}

function curveState(map, state) {
  return { axis: state.curveAxis, coordinate: state.coordinates[state.curveAxis], scale: state.curveScale, points: curvePoints(state),
    regime: state.colourByRegime ? regimeOf(map, state.contact) : undefined };
}

function curveFigure(map, state) {
  return {
    name: () => `curves_${state.variable.name}`,
    get title() { return sentence(`${words(state.variable.name)} along ${symbolText(map.axes[state.curveAxis].coordinates[state.coordinates[state.curveAxis]].name)}`); },
    get caption() {
      return curvePoints(state).length > 1 ? "" : map.axes.map((axis, a) => (a === state.curveAxis || axis.size < 2 ? "" : coordinateText(axis.coordinates[0], state.index[a]))).filter(Boolean).join(", ");
    },
    draw: (canvas) => responseCurves(canvas, map, state.variable, curveState(map, state)),
    table: () => responseCurvesTable(map, state.variable, curveState(map, state)),
  };
}

function slider(map, axis, state, moved) {
  const { coordinates, size } = map.axes[axis];
  const text = () => coordinates.map((coordinate) => coordinateText(coordinate, state.index[axis])).join(", ");
  const label = element("span", {}, text());
  const input = element("input", { type: "range", min: 0, max: size - 1, step: 1, value: state.index[axis], "data-axis": map.axes[axis].name, "aria-label": map.axes[axis].name, oninput: () => {
    state.index = state.index.map((i, a) => (a === axis ? Number(input.value) : i));
    label.textContent = text();
    moved();
  } });
  return { row: element("label", { class: "control" }, label, input), refresh: () => { input.value = state.index[axis]; label.textContent = text(); } };
}

function tick(label, checked, changed) {
  const box = element("input", { type: "checkbox", checked, onchange: () => changed(box.checked) });
  return element("label", { class: "control tick" }, box, element("span", {}, label));
}

// Axes with more than one point, and of each which of its coordinates.
function coordinateChoices(map, axes) {
  return axes.flatMap((axis) => map.axes[axis].coordinates.map((coordinate, c) => [`${axis}:${c}`, coordinate])
    .filter(([, { monotone }]) => monotone).map(([key, coordinate]) => [key, coordinateLabel(coordinate)]));
}

function explorer(record) {
  const { map } = record;
  const state = firstState(record);
  const wide = map.axes.map((_, a) => a).filter((a) => map.axes[a].size > 1);
  const controls = element("div", { class: "controls" }), sliders = element("div", { class: "controls" });
  const curveControls = element("div", { class: "controls" });
  const place = element("div", {});
  const mapShown = state.y === null ? null : figureCard(mapFigure(map, state), about(record));
  const curvesShown = figureCard(curveFigure(map, state), about(record));
  const shares = dissipating(map.variables);
  const sharesShown = shares.length && wide.length ? figureCard({
    name: "damping_budget", title: "Damping budget: who dissipates", caption: "Along the axis of the curves, through the point of the sliders.",
    draw: (canvas) => energyShares(canvas, map, shares, { axis: state.curveAxis, coordinate: state.coordinates[state.curveAxis], index: state.index }),
    table: () => energySharesTable(map, shares, { axis: state.curveAxis, index: state.index }),
  }, about(record)) : null;
  let rows = [];

  let waiting = false;
  function redraw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      mapShown?.redraw();
      curvesShown.redraw();
      sharesShown?.redraw();
      place.replaceChildren(pointCard(record, state.index));
    });
  }
  function arrange() {
    controls.replaceChildren(...mapControls());
    curveControls.replaceChildren(...controlsOfCurves());
    rows = wide.filter((axis) => state.y === null || (axis !== state.x && axis !== state.y)).map((axis) => slider(map, axis, state, redraw));
    sliders.replaceChildren(...rows.map(({ row }) => row));
    redraw();
  }
  function pick(index, keep) {
    if (keep) state.kept = [...state.kept, state.index];
    state.index = index;
    rows.forEach(({ refresh }) => refresh());
    redraw();
  }
  function setAxis(which, text) {
    const [axis, coordinate] = text.split(":").map(Number);
    if (axis === state[which === "x" ? "y" : "x"]) [state.x, state.y] = [state.y, state.x];
    else state[which] = axis;
    state.coordinates[axis] = coordinate;
    arrange();
  }
  function mapControls() {
    const quantity = choice("quantity", map.variables.map(({ name }) => [name, words(name)]), state.variable.name, (name) => {
      state.variable = map.variable(name);
      redraw();
    });
    if (state.y === null) return [quantity];
    const contacts = contactsOf(record);
    return [quantity,
      choice("across", coordinateChoices(map, wide), `${state.x}:${state.coordinates[state.x]}`, (text) => setAxis("x", text)),
      choice("up", coordinateChoices(map, wide), `${state.y}:${state.coordinates[state.y]}`, (text) => setAxis("y", text)),
      choice("colours", [["linear", "linear"], ["log", "logarithmic"]], state.scale, (scale) => { state.scale = scale; redraw(); }),
      choice("palette", [["viridis", "viridis"], ["cividis", "cividis"]], state.colours, (colours) => { state.colours = colours; redraw(); }),
      contacts.length ? choice("contact", contacts.map((name) => [name, words(name)]), state.contact, (contact) => { state.contact = contact; redraw(); }) : null,
    ].filter(Boolean);
  }
  function controlsOfCurves() {
    const keep = element("button", { type: "button", id: "keep", onclick: () => { state.kept = [...curvePoints(state)]; redraw(); } }, "keep this curve");
    const clear = element("button", { type: "button", onclick: () => { state.kept = []; redraw(); } }, "clear kept");
    return [
      choice("along", coordinateChoices(map, wide), `${state.curveAxis}:${state.coordinates[state.curveAxis]}`, (text) => {
        const [axis, coordinate] = text.split(":").map(Number);
        state.curveAxis = axis;
        state.coordinates[axis] = coordinate;
        redraw();
      }),
      choice("scale", [["linear", "linear"], ["log", "logarithmic"], ["dB", "dB"]], state.curveScale, (scale) => { state.curveScale = scale; redraw(); }),
      regimeOf(map, state.contact) ? tick("colour by regime", state.colourByRegime, (on) => { state.colourByRegime = on; redraw(); }) : null,
      wide.length > 1 ? keep : null, wide.length > 1 ? clear : null,
    ].filter(Boolean);
  }

  arrange();
  if (mapShown) followPointer(mapShown, map, state, (index) => pointTip(record, index, state.variable), pick);
  const hint = mapShown ? element("p", { class: "note hint" }, "Point at the map to read it; click to take a point for the curves, with Shift to keep the one before.") : null;
  return [
    section(mapShown ? "Response map" : "Response", controls, sliders, mapShown ? mapShown.card : null, hint),
    section("Response curves", curveControls, curvesShown.card, sharesShown?.card ?? null),
    section("Point", place),
  ];
}

// What is not there, and why.
function gaps(record) {
  const { map, provenance } = record;
  const notes = [];
  const add = (text) => notes.push(element("p", { class: "warning" }, text));
  if (provenance.missing_tiles) add(`This is part of a map: ${provenance.missing_tiles} of its tiles were not computed. Their points are grey. frahm run, or frahm merge when all tasks are done, completes the file.`);
  const status = map.variable("status");
  const codes = new Map();
  for (const value of status?.values ?? []) codes.set(value, (codes.get(value) ?? 0) + 1);
  const counts = new Map([...codes].map(([code, count]) => [meaningOf(status, code) || "not_computed", count]));
  const told = { failed: "failed (no number; the reasons are below)", unbounded: "have no bounded response (an undamped mode driven at resonance)", not_computed: "were not computed" };
  for (const [word, text] of Object.entries(told)) if (counts.get(word)) add(`${counts.get(word)} of ${map.points} points ${text}.`);
  if (counts.get("grazing")) notes.push(element("p", { class: "note" }, `${counts.get("grazing")} of ${map.points} points only just touch another regime (grazing): right responses, without a derivative.`));
  return { notes, failed: provenance.failed_points };
}

function facts(record) {
  const { map } = record;
  const axes = map.axes.map((axis) => [axis.coordinates.map(coordinateLabel).join("; "), axis.size,
    axis.coordinates.map(({ values }) => (values.length > 1 ? `${Number(values[0].toPrecision(6))} \u2026 ${Number(values.at(-1).toPrecision(6))}` : values[0])).join("; ")]);
  return section("Axes", element("p", { class: "note" }, `${map.points} points`), table(["axis", "points", "from \u2026 to"], axes, { numeric: [1] }));
}

function leftOut(record) {
  const { leftOut: names } = record.map;
  if (!names.length) return null;
  const chosen = [...record.map.variables.map(({ name }) => name), "..."].join(",");
  return section("Not in this page", element("p", {}, `The file also holds ${names.map(({ name }) => name).join(", ")}.`),
    element("p", { class: "note" }, "To include them: ", element("code", {}, `frahm report ${record.file} --quantities ${chosen}`), " or [report] quantities in the study."));
}

function orbitSection(record) {
  const group = record.groups.get("orbits");
  const count = group?.values("row_start")?.length ?? 0;
  if (!count) return null;
  const cards = element("div", { class: "cards" });
  const label = (k) => orbitLabel(group, k, symbolText, unitText);
  const show = (k) => {
    const figures = orbitFigures(orbitSamples(group, k), label(k), `_${k + 1}`);
    cards.replaceChildren(...(figures.length ? figures.map((figure) => figureCard(figure, about(record)).card) : [element("p", { class: "warning" }, "This point has no orbit: it failed, or has no bounded response.")]));
  };
  show(0);
  const list = choice("orbit", Array.from({ length: count }, (_, k) => [k, label(k)]), 0, (k) => show(Number(k)));
  return section("Orbits kept", element("div", { class: "controls" }, list), cards);
}

function resonanceSection(record) {
  const group = record.groups.get("resonance");
  if (!group?.along("curve").length) return null;
  const state = { quantity: resonanceQuantities(group)[0], x: firstParameter(group) };
  if (!resonanceParameters(group).length) {
    const rows = resonanceQuantities(group).map(({ name, unit, values }) => [words(name), String(Number(values[0].toPrecision(8))), unitText(unit)]);
    return section("Resonance", table(["", "value", "unit"], rows, { numeric: [1] }));
  }
  const shown = figureCard({ name: "resonance", get title() { return sentence(state.quantity.long_name || words(state.quantity.name)); },
    caption: "Solved along the frequency axis, not sampled.",
    draw: (canvas) => resonanceFigure(canvas, group, state.quantity, state.x), table: () => resonanceTable(group) }, about(record));
  const chooser = (label, columns, key) => choice(label, columns.map(({ name }) => [name, words(name)]), state[key].name, (name) => { state[key] = columns.find((column) => column.name === name); shown.redraw(); });
  return section("Resonance", element("div", { class: "controls" }, chooser("quantity", resonanceQuantities(group), "quantity"), chooser("over", [...resonanceParameters(group), curveNumbers(group)], "x")), shown.card);
}

export function sweepParts(record) {
  const { notes, failed } = gaps(record);
  const anything = record.map.variables.some(({ values }) => values.some((value) => !Number.isNaN(value)));
  const reasons = failed ? section("Points that failed", element("pre", {}, failed)) : null;
  return [...notes, ...(record.map.points && anything ? explorer(record) : []), orbitSection(record), resonanceSection(record), reasons,
    facts(record), leftOut(record)].filter(Boolean);
}

// For papers: each number's map in the middle of the other axes, curves of it at the ends and the middle of the
// next axis, orbits, resonances.
export function sweepFigures(record) {
  const { map } = record;
  const state = firstState(record);
  const figures = [];
  const crossings = crossingsOf(record, state.contact);
  for (const variable of map.variables) {
    const slice = { ...state, variable, crossings: new Map([[state.contact, crossings]]) };
    if (state.y !== null) figures.push({ ...plain(mapFigure(map, slice)), name: `map_${variable.name}` });
    if (variable.kind !== "float") continue;
    const at = (i) => state.index.map((k, a) => (a === state.y ? i : k));
    const last = state.y === null ? 0 : map.axes[state.y].size - 1;
    const kept = state.y === null ? [] : [...new Set([0, Math.round(last / 2), last])].map(at);
    figures.push({ ...plain(curveFigure(map, { ...slice, kept, index: kept[0] ?? state.index })), name: `curves_${variable.name}` });
  }
  const orbits = record.groups.get("orbits");
  for (let k = 0; k < (orbits?.values("row_start")?.length ?? 0); ++k) figures.push(...orbitFigures(orbitSamples(orbits, k), orbitLabel(orbits, k, symbolText, unitText), `_${k + 1}`));
  const resonance = record.groups.get("resonance");
  if (resonance && resonanceParameters(resonance).length) {
    for (const quantity of resonanceQuantities(resonance)) {
      figures.push({ name: quantity.name, title: quantity.long_name, draw: (canvas) => resonanceFigure(canvas, resonance, quantity, firstParameter(resonance)), table: () => resonanceTable(resonance) });
    }
  }
  return figures;
}

const plain = (figure) => ({ title: figure.title, caption: figure.caption, draw: figure.draw, table: figure.table });
