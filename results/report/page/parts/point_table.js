// One point of the map: its parameters, all quantities on the page, and the command that computes it again.
import { axisText, coordinateText, pointCommand } from "../axes.js";
import { meaningOf } from "../record.js";
import { numberText, unitText, words } from "../units.js";
import { element, table } from "./elements.js";

const shownDigits = 8; // if the page has all digits

// A quantity at a point as text, in the unit of the record.
export function valueText(map, variable, index) {
  const value = map.value(variable, index);
  if (variable.kind === "flag")
    return words(meaningOf(variable, map.value(variable, index))) || "not computed";
  return numberText(value, variable.digits ?? shownDigits);
}

function pointRows(map, index, variables) {
  return variables.map((variable) => [
    words(variable.name),
    valueText(map, variable, index),
    unitText(variable.unit),
  ]);
}

function pointPlace(map, index) {
  return map.axes.flatMap((axis, a) =>
    axis.coordinates.map((coordinate) => coordinateText(coordinate, index[a])),
  );
}

// The tip shown while the pointer is over the map.
export function pointTip(record, index, first, variables) {
  const { map } = record;
  const shown = [first, ...variables.filter((variable) => variable !== first)].slice(0, 14);
  return element(
    "div",
    {},
    element("strong", {}, pointPlace(map, index).join(", ")),
    table(["", "", ""], pointRows(map, index, shown), { numeric: [1] }),
    element("code", {}, pointCommand(record, index)),
  );
}

// The meaning of the regimes' names, if a regime is recorded.
function regimeNote({ variables }) {
  return variables.some(({ name }) => name.endsWith("_regime"))
    ? "Regimes, by the number of stops of finite length in a period: non stop, none; one stop, one or two; multi stop, " +
        "more; stuck, it never slides. "
    : "";
}

// variables: those in its table; the command gives all.
export function pointCard(record, index, variables) {
  const { map } = record;
  const command = pointCommand(record, index);
  const copy = element(
    "button",
    { type: "button", onclick: () => navigator.clipboard?.writeText(command) },
    "copy",
  );
  const rows = pointRows(map, index, variables).map((row, v) => [...row, variables[v].long_name]);
  const others = map.variables.length - variables.length;
  const half = Math.ceil(rows.length / 2);
  return element(
    "div",
    { class: "card", id: "point" },
    element("h3", {}, `The point ${map.axes.map((axis, a) => axisText(map, axis, index[a])).join(", ")}`),
    element(
      "div",
      { class: "cards" },
      [rows.slice(0, half), rows.slice(half)]
        .filter((some) => some.length)
        .map((some) => table(["quantity", "value", "unit", "meaning"], some, { numeric: [1] })),
    ),
    element(
      "p",
      { class: "note" },
      `${regimeNote(map)}${others ? `Find ${others} more quantities by their names above the map. ` : ""}` +
        "Values have six digits, the last uncertain by one. This command prints all of them, with residual, error bound and energy balance:",
    ),
    element("div", { class: "command" }, element("code", {}, command), copy),
  );
}
