// The numbers of a figure of curves, points and bands (line_figure.js), for its CSV.

// Columns: curves over the same x follow it together; the name of each further x includes that of its curve.
export function tableOf(spec) {
  const columns = [],
    across = spec.x.name ?? spec.x.label;
  let last = null;
  for (const { name, x, y } of [...(spec.lines ?? []), ...(spec.points ?? [])].filter(
    ({ silent }) => !silent,
  )) {
    if (x !== last) columns.push({ name: last ? `${name}_${across}` : across, unit: spec.x.unit, values: x });
    last = x;
    columns.push({ name, unit: spec.y.unit, values: y });
  }
  for (const { text, from, to } of spec.bands ?? []) {
    columns.push(
      { name: `${text}, from`, unit: spec.x.unit, values: from },
      { name: `${text}, to`, unit: spec.x.unit, values: to },
    );
  }
  return columns;
}
