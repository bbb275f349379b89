// One point of the map: its parameters, all quantities the page holds, and the command that computes it again.
import { axisText, coordinateText, pointCommand } from "../axes.js";
import { meaningOf } from "../record.js";
import { numberText, unitText, words } from "../units.js";
import { element, table } from "./elements.js";

// A quantity at a point as text, in the unit of the record: six digits of its range are in the page.
export function valueText(map, variable, index) {
  const value = map.value(variable, index);
  if (variable.kind === "flag")
    return words(meaningOf(variable, map.value(variable, index))) || "not computed";
  return numberText(value, 7);
}

export function pointRows(map, index, variables = map.variables) {
  return variables.map((variable) => [
    words(variable.name),
    valueText(map, variable, index),
    unitText(variable.unit),
  ]);
}

export function pointPlace(map, index) {
  return map.axes.flatMap((axis, a) =>
    axis.coordinates.map((coordinate) => coordinateText(coordinate, index[a])),
  );
}

// For a pointer over the map.
export function pointTip(record, index, first) {
  const { map } = record;
  const shown = [first, ...map.variables.filter((variable) => variable !== first)].slice(0, 14);
  return element(
    "div",
    {},
    element("strong", {}, pointPlace(map, index).join(", ")),
    table(["", "", ""], pointRows(map, index, shown), { numeric: [1] }),
    element("code", {}, pointCommand(record, index)),
  );
}

export function pointCard(record, index) {
  const { map } = record;
  const command = pointCommand(record, index);
  const copy = element(
    "button",
    { type: "button", onclick: () => navigator.clipboard?.writeText(command) },
    "copy",
  );
  const rows = pointRows(map, index);
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
        .map((some) => table(["quantity", "value", "unit"], some, { numeric: [1] })),
    ),
    element(
      "p",
      { class: "note" },
      "Values to six digits. All of them, with residual, error bound and energy balance:",
    ),
    element("div", { class: "command" }, element("code", {}, command), copy),
  );
}
