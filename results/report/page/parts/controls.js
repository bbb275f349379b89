// Sliders, lists and ticks.
import { coordinateText } from "../axes.js";
import { words } from "../units.js";
import { element } from "./elements.js";

// A drop-down list of [value, text]; chosen(value) is called when the choice changes.
export function choice(label, options, selected, chosen) {
  const list = element(
    "select",
    { onchange: (event) => chosen(event.target.value) },
    options.map(([value, text]) =>
      element("option", { value, selected: String(value) === String(selected) }, text),
    ),
  );
  return element("label", { class: "control" }, element("span", {}, label), list);
}

// A choice among many names: those listed, and a field that finds any other as it is typed. Returns its elements.
export function choiceOfMany(label, names, listed, selected, chosen) {
  const options = listed.map((name) => [name, words(name)]);
  if (listed.length === names.length) return [choice(label, options, selected, chosen)];
  const known = new Map(names.map((name) => [words(name), name]));
  const list = `all-of-${label.replaceAll(" ", "-")}`;
  const field = element("input", {
    type: "search",
    list,
    placeholder: `any of ${names.length}`,
    onchange: () => known.has(field.value) && chosen(known.get(field.value)),
  });
  const found = element(
    "datalist",
    { id: list },
    [...known.keys()].map((text) => element("option", { value: text })),
  );
  const other = element("label", { class: "control" }, element("span", {}, `find a ${label}`), field, found);
  return [choice(label, options, selected, chosen), other];
}

export function tick(label, checked, changed) {
  const box = element("input", { type: "checkbox", checked, onchange: () => changed(box.checked) });
  return element("label", { class: "control tick" }, box, element("span", {}, label));
}

// Over the points of an axis {name, size, coordinates}; at(): the current index, moved(index).
// Returns {row, refresh}.
export function slider({ name, size, coordinates }, at, moved) {
  const text = () => coordinates.map((coordinate) => coordinateText(coordinate, at())).join(", ");
  const label = element("span", {}, text());
  const input = element("input", {
    type: "range",
    min: 0,
    max: size - 1,
    step: 1,
    value: at(),
    "data-axis": name,
    "aria-label": name,
    oninput: () => {
      moved(Number(input.value));
      label.textContent = text();
    },
  });
  const refresh = () => {
    input.value = at();
    label.textContent = text();
  };
  return { row: element("label", { class: "control" }, label, input), refresh };
}
