// The page of a map: what is missing, the map itself, kept orbits, resonances, axes, what is not in the page.
import { coordinateLabel, symbolText } from "../axes.js";
import { orbitFigures, orbitLabel, orbitSamples } from "../figures/orbit_figures.js";
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
import { about } from "../parts/heading.js";
import { meaningOf } from "../record.js";
import { sentence, unitText, words } from "../units.js";
import { explorerSections } from "./explorer.js";
import { curveFigure, mapFigure } from "./map_figures.js";
import { firstState } from "./sweep_state.js";

// What is not there, and why.
function gaps(record) {
  const { map, provenance } = record;
  const notes = [];
  const add = (text) => notes.push(element("p", { class: "warning" }, text));
  if (provenance.missing_tiles)
    add(
      `This is part of a map: ${provenance.missing_tiles} of its tiles were not computed. Their points are grey. frahm run, or frahm merge when all tasks are done, completes the file.`,
    );
  const status = map.variable("status");
  const codes = new Map();
  for (const value of status?.values ?? []) codes.set(value, (codes.get(value) ?? 0) + 1);
  const counts = new Map(
    [...codes].map(([code, count]) => [meaningOf(status, code) || "not_computed", count]),
  );
  const told = {
    failed: "failed (no number; the reasons are below)",
    unbounded: "have no bounded response (an undamped mode driven at resonance)",
    not_computed: "were not computed",
  };
  for (const [word, text] of Object.entries(told))
    if (counts.get(word)) add(`${counts.get(word)} of ${map.points} points ${text}.`);
  if (counts.get("grazing"))
    notes.push(
      element(
        "p",
        { class: "note" },
        `${counts.get("grazing")} of ${map.points} points only just touch another regime (grazing): right responses, without a derivative.`,
      ),
    );
  return { notes, failed: provenance.failed_points };
}

function facts(record) {
  const { map } = record;
  const axes = map.axes.map((axis) => [
    axis.coordinates.map(coordinateLabel).join("; "),
    axis.size,
    axis.coordinates
      .map(({ values }) =>
        values.length > 1
          ? `${Number(values[0].toPrecision(6))} \u2026 ${Number(values.at(-1).toPrecision(6))}`
          : values[0],
      )
      .join("; "),
  ]);
  return section(
    "Axes",
    element("p", { class: "note" }, `${map.points} points`),
    table(["axis", "points", "from \u2026 to"], axes, { numeric: [1] }),
  );
}

function leftOut(record) {
  const { leftOut: names } = record.map;
  if (!names.length) return null;
  const chosen = [...record.map.variables.map(({ name }) => name), "..."].join(",");
  return section(
    "Not in this page",
    element("p", {}, `The file also holds ${names.map(({ name }) => name).join(", ")}.`),
    element(
      "p",
      { class: "note" },
      "To include them: ",
      element("code", {}, `frahm report ${record.file} --quantities ${chosen}`),
      " or [report] quantities in the study.",
    ),
  );
}

function orbitSection(record) {
  const group = record.groups.get("orbits");
  const count = group?.values("row_start")?.length ?? 0;
  if (!count) return null;
  const cards = element("div", { class: "cards" });
  const label = (k) => orbitLabel(group, k, symbolText, unitText);
  const show = (k) => {
    const figures = orbitFigures(orbitSamples(group, k), label(k), `_${k + 1}`);
    cards.replaceChildren(
      ...(figures.length
        ? figures.map((figure) => figureCard(figure, about(record)).card)
        : [
            element(
              "p",
              { class: "warning" },
              "This point has no orbit: it failed, or has no bounded response.",
            ),
          ]),
    );
  };
  show(0);
  const list = choice(
    "orbit",
    Array.from({ length: count }, (_, k) => [k, label(k)]),
    0,
    (k) => show(Number(k)),
  );
  return section("Orbits kept", element("div", { class: "controls" }, list), cards);
}

function resonanceSection(record) {
  const group = record.groups.get("resonance");
  if (!group?.along("curve").length) return null;
  const state = { quantity: resonanceQuantities(group)[0], x: firstParameter(group) };
  if (!resonanceParameters(group).length) {
    const rows = resonanceQuantities(group).map(({ name, unit, values }) => [
      words(name),
      String(Number(values[0].toPrecision(8))),
      unitText(unit),
    ]);
    return section("Resonance", table(["", "value", "unit"], rows, { numeric: [1] }));
  }
  const shown = figureCard(
    {
      name: "resonance",
      get title() {
        return sentence(state.quantity.long_name || words(state.quantity.name));
      },
      get caption() {
        return resonanceNote(group, state.x);
      },
      draw: (canvas) => resonanceFigure(canvas, group, state.quantity, state.x),
      table: () => resonanceTable(group),
    },
    about(record),
  );
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
  return section(
    "Resonance",
    element(
      "div",
      { class: "controls" },
      chooser("quantity", resonanceQuantities(group), "quantity"),
      chooser("over", [...resonanceParameters(group), curveNumbers(group)], "x"),
    ),
    shown.card,
  );
}

const failuresAtOnce = 12;

// The first reasons, and the others behind a click.
function failureList(failed) {
  const lines = failed.split("\n");
  const rest = lines.slice(failuresAtOnce);
  const more = element(
    "details",
    {},
    element("summary", {}, `${rest.length} more`),
    element("pre", {}, rest.join("\n")),
  );
  return element(
    "div",
    {},
    element("pre", {}, lines.slice(0, failuresAtOnce).join("\n")),
    rest.length ? more : null,
  );
}

export function sweepParts(record) {
  const { notes, failed } = gaps(record);
  const anything = record.map.variables.some(({ values }) => values.some((value) => !Number.isNaN(value)));
  const reasons = failed ? section("Points that failed", failureList(failed)) : null;
  return [
    ...notes,
    ...(record.map.points && anything ? explorerSections(record) : []),
    orbitSection(record),
    resonanceSection(record),
    reasons,
    facts(record),
    leftOut(record),
  ].filter(Boolean);
}

// For papers: each number's map in the middle of the other axes, curves of it at the ends and the middle of the
// next axis, orbits, resonances.
export function sweepFigures(record) {
  const { map } = record;
  const state = firstState(record);
  const figures = [];
  for (const variable of map.variables) {
    const slice = { ...state, variable };
    if (state.y !== null) figures.push({ ...plain(mapFigure(map, slice)), name: `map_${variable.name}` });
    if (variable.kind !== "float") continue;
    const at = (i) => state.index.map((k, a) => (a === state.y ? i : k));
    const last = state.y === null ? 0 : map.axes[state.y].size - 1;
    const kept = state.y === null ? [] : [...new Set([0, Math.round(last / 2), last])].map(at);
    figures.push({
      ...plain(curveFigure(map, { ...slice, kept, index: kept[0] ?? state.index })),
      name: `curves_${variable.name}`,
    });
  }
  const orbits = record.groups.get("orbits");
  for (let k = 0; k < (orbits?.values("row_start")?.length ?? 0); ++k)
    figures.push(
      ...orbitFigures(orbitSamples(orbits, k), orbitLabel(orbits, k, symbolText, unitText), `_${k + 1}`),
    );
  const resonance = record.groups.get("resonance");
  if (resonance && resonanceParameters(resonance).length) {
    for (const quantity of resonanceQuantities(resonance)) {
      figures.push({
        name: quantity.name,
        title: quantity.long_name,
        draw: (canvas) => resonanceFigure(canvas, resonance, quantity, firstParameter(resonance)),
        table: () => resonanceTable(resonance),
      });
    }
  }
  return figures;
}

const plain = (figure) => ({
  title: figure.title,
  caption: figure.caption,
  draw: figure.draw,
  table: figure.table,
});
