// An identification as its page sees it, read from the group /identification: estimates, fitted series, rows.

function estimateOf(group, name, names) {
  const column = group.column(name),
    number = (suffix) => group.number(`${name}_${suffix}`);
  return {
    name,
    unit: column?.unit ?? "1",
    meaning: column?.long_name ?? "",
    value: group.number(name),
    low: number("low"),
    high: number("high"),
    standardError: number("standard_error"),
    degreesOfFreedom: number("degrees_of_freedom"),
    correlation: Array.from(group.values(`${name}_correlation`) ?? [], (value, i) => ({
      with: names[i],
      value,
    })),
  };
}

// Every series that was fitted: {record, quantity, along, measured, fitted, residual, nrmse}.
function seriesOf(group, records) {
  return group.columns
    .filter(({ name }) => name.endsWith("_measured") && group.has(name.replace(/_measured$/, "_fitted")))
    .map((measured) => {
      const whole = measured.name.slice(0, -"_measured".length);
      const record =
        [...records]
          .sort((a, b) => b.length - a.length)
          .find((name) => measured.dimension.startsWith(`${name}_`) && whole.startsWith(`${name}_`)) ?? "";
      const without = (name) => (record ? name.slice(record.length + 1) : name);
      return {
        name: whole,
        record,
        quantity: without(whole),
        over: without(measured.dimension),
        along: group.column(measured.dimension),
        measured,
        fitted: group.column(`${whole}_fitted`),
        residual: group.column(`${whole}_residual`),
        nrmse: group.number(`${whole}_nrmse`),
      };
    });
}

function rowsOf(group) {
  const columns = group.along("row").filter(({ name }) => name !== "row");
  if (columns.length === 0) return null;
  const labels = group.texts.row_labels
    ? group.texts.row_labels.split("\n")
    : Array.from(columns[0].values, (_, i) => String(i + 1));
  return { labels, columns };
}

export function identificationOf(record) {
  const group = record.groups.get("identification"),
    { texts } = group;
  const listOf = (text) => (text ?? "").split(" ").filter(Boolean);
  const names = listOf(texts.estimates),
    records = listOf(texts.records);
  const first = names
    .map((name) => `first_${name}`)
    .filter((name) => group.has(name) && !names.includes(name));
  return {
    group,
    method: texts.method ?? "",
    outcome: group.word("outcome"),
    records,
    estimates: names.map((name) => estimateOf(group, name, names)),
    first: first.map((name) => estimateOf(group, name, [])),
    series: seriesOf(group, records),
    rows: rowsOf(group),
    quality: records.map((name, i) => ({ record: name, nrmse: group.values("nrmse")?.[i] ?? NaN })),
    notes: (texts.notes ?? "").split("\n").filter(Boolean),
  };
}

// What the interval of an estimate tells: "determined", "undetermined" (by the data) or "untold" (as many unknowns
// as data).
export function certainty({ value, low, high }) {
  if (Number.isNaN(value) || low === -Infinity || high === Infinity) return "undetermined";
  return Number.isNaN(low) || Number.isNaN(high) ? "untold" : "determined";
}

// Root mean square of what the model leaves of the data.
export function residualRms({ residual }) {
  const known = Array.from(residual.values).filter(Number.isFinite);
  return Math.sqrt(known.reduce((sum, value) => sum + value * value, 0) / known.length);
}

// The two different estimates whose correlation is largest: {a, b, value}, or null.
export function closestPair(estimates) {
  let closest = null;
  estimates.forEach(({ name, correlation }, i) =>
    correlation.forEach(({ with: other, value }, j) => {
      if (j > i && Math.abs(value) > Math.abs(closest?.value ?? 0)) closest = { a: name, b: other, value };
    }),
  );
  return closest;
}
