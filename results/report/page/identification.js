// An identification as its page uses it, read from the group /identification: estimates, fitted series, rows.

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

// What the interval of an estimate shows: "determined", "undetermined" (by the data) or "untold" (as many unknowns
// as data).
export function certainty({ value, low, high }) {
  if (Number.isNaN(value) || low === -Infinity || high === Infinity) return "undetermined";
  return Number.isNaN(low) || Number.isNaN(high) ? "untold" : "determined";
}

// Root mean square of the residuals.
export function residualRms({ residual }) {
  const known = Array.from(residual.values).filter(Number.isFinite);
  return Math.sqrt(known.reduce((sum, value) => sum + value * value, 0) / known.length);
}

// The independent estimates of each method, each by the first of its names in the record; the other estimates follow
// from them. For a method not named here all estimates are independent.
const independentOf = {
  added_mass: [["mass"], ["stiffness"]],
  energy_balance: [["damping"], ["friction_force"]],
  forced_resonance: [
    ["damping", "damping_ratio"],
    ["friction_force", "friction_displacement"],
  ],
  free_decay: [
    ["damping", "damping_ratio"],
    ["friction_force", "friction_displacement"],
    ["natural_frequency"],
  ],
  half_power: [["damping_ratio"], ["natural_frequency"]],
  hysteresis_loop: [["storage_stiffness"], ["equivalent_damping"]],
  log_decrement: [["damping_ratio"], ["natural_frequency"]],
};

export function independentEstimates({ method, estimates }) {
  const chosen = independentOf[method];
  if (!chosen) return estimates;
  return chosen
    .map((names) => names.map((name) => estimates.find((estimate) => estimate.name === name)).find(Boolean))
    .filter(Boolean);
}

// Pairs of independent estimates whose correlation is at least `least`: [{a, b, value}], the closest first.
export function closePairs(identification, least) {
  const independent = independentEstimates(identification);
  const pairs = independent.flatMap((one, i) =>
    independent.slice(i + 1).map((other) => ({
      a: one.name,
      b: other.name,
      value: one.correlation.find((correlation) => correlation.with === other.name)?.value ?? NaN,
    })),
  );
  return pairs
    .filter(({ value }) => Math.abs(value) >= least)
    .sort((p, q) => Math.abs(q.value) - Math.abs(p.value));
}

// Whether a record has more data than independent estimates, so that its fit quality means something.
export function hasFreedom({ series, ...identification }, record) {
  const own = series.filter((one) => one.record === record);
  const data = own.reduce((sum, { measured }) => sum + measured.values.length, 0);
  return own.length === 0 || data > independentEstimates(identification).length;
}
