// One motion as its page uses it, a free vibration (/decay) or a forced one (/transient): masses, with the signals of the
// study among them, stops, energies.

function namesWith(group, end, dimension) {
  return group.columns
    .filter(
      (column) => column.name.endsWith(end) && (dimension === undefined || column.dimension === dimension),
    )
    .map(({ name }) => name.slice(0, -end.length));
}

// Leading numbers of a column that ends in NaN.
function known(values) {
  let count = values?.length ?? 0;
  while (count > 0 && Number.isNaN(values[count - 1])) --count;
  return values?.subarray(0, count) ?? new Float64Array(0);
}

// A mass that starts from rest at zero does not turn there, unless it never moves.
function turnsOf(group, name) {
  const times = known(group.values(`${name}_extremum_time`));
  const points = group.values(`${name}_extremum`)?.subarray(0, times.length) ?? new Float64Array(0);
  const from = times.length > 1 && times[0] === 0 && points[0] === 0 ? 1 : 0;
  return {
    turningTimes: times.subarray(from),
    turningPoints: points.subarray(from),
    decrements: known(group.values(`${name}_log_decrement`)?.subarray(from)),
  };
}

// A mass, or a signal: a combination of displacements.
function nodeOf(group, name, isSignal) {
  const number = (suffix) => group.number(`${name}_${suffix}`);
  return {
    name,
    noun: isSignal ? "signal" : "mass",
    displacement: group.column(`${name}_displacement`),
    velocity: group.column(`${name}_velocity`),
    unit:
      (
        group.column(`${name}_displacement`) ??
        group.column(`${name}_extremum`) ??
        group.column(`${name}_peak`)
      )?.unit ?? "1",
    ...turnsOf(group, name),
    rest: number("rest"),
    peak: number("peak"),
    peakTime: number("peak_time"),
  };
}

// The intervals in which a contact sticks; a contact never released sticks to the end.
function stopsOf(group, name, end) {
  const from = known(group.values(`${name}_stop_onset`));
  const released = group.values(`${name}_release`);
  return {
    name,
    from,
    to: Float64Array.from(from, (_, i) => (Number.isNaN(released[i]) ? end : released[i])),
  };
}

function energiesOf(group) {
  return namesWith(group, "_energy_share", "").map((name) => ({
    name,
    energy: group.number(`${name}_energy`),
    share: group.number(`${name}_energy_share`),
    dissipated: group.column(`${name}_dissipated`),
  }));
}

// Units as the record has them: those of a dimensionless study are 1.
function unitsOf({ columns }) {
  const of = (pattern, otherwise) => columns.find(({ name }) => pattern.test(name))?.unit ?? otherwise;
  return { time: of(/^time$|^duration$|_peak_time$|_stop_onset$/, "s"), energy: of(/_energy$/, "J") };
}

// The frequency of a run in rad/s, from the unit that the study uses, such as rpm.
function inRadians(column, study) {
  const unit = study?.column("frequency_unit");
  if (!unit || unit.unit !== column.unit) return column;
  return { ...column, unit: "rad s-1", values: column.values.map((value) => value * unit.values[0]) };
}

// The records that drive the motion, each along times of its own: [{name, time, values, unit, meaning}].
function recordsOf(group) {
  return group.columns
    .filter(({ name }) => /_recorded_(acceleration|velocity|displacement|force)(_\d+)?$/.test(name))
    .map(({ name, values, unit, long_name: meaning }) => ({
      name,
      time: group.values(`${name}_time`),
      values,
      unit,
      meaning,
    }))
    .filter(({ time }) => time);
}

// kind: "decay" or "transient".
export function motionOf(record, kind) {
  const group = record.groups.get(kind);
  const time = group.column("time");
  const duration = Number.isFinite(group.number("duration"))
    ? group.number("duration")
    : (time?.values.at(-1) ?? NaN);
  const names = new Set([
    ...namesWith(group, "_displacement", "time"),
    ...namesWith(group, "_extremum", "extremum"),
    ...namesWith(group, "_peak", ""),
  ]);
  const recorded = group.column("frequency"),
    frequency = recorded?.dimension === "time" ? recorded : null;
  const signals = new Set((record.groups.get("study")?.texts.signals ?? "").split(","));
  const fact = (name) => record.groups.get("study")?.number(name) ?? NaN;
  return {
    kind,
    group,
    time,
    units: unitsOf(group),
    records: recordsOf(group),
    excitation: fact("excitation_frequency"),
    mayStop: fact("rubbing_elements") !== 0,
    followed: fact("given_duration") === 0, // no duration given: followed to its end
    hysteretic: fact("hysteretic_elements") !== 0,
    duration,
    stopTime: group.number("stop_time"),
    masses: [...names].map((name) => nodeOf(group, name, signals.has(name))), // and signals
    stops: namesWith(group, "_stop_onset", "stop")
      .map((name) => stopsOf(group, name, duration))
      .filter(({ from }) => from.length > 0),
    energies: energiesOf(group),
    angularFrequency: frequency && inRadians(frequency, record.groups.get("study")),
    frequency,
    discretisationError: group.number("discretisation_error"),
  };
}

const leastSamples = 8; // per period, for lines between samples to show the motion
const goodSamples = 20; // per period, recommended
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

// The period of the mass that turns most often: twice the median time between its turning points.
function periodOfTurning({ masses }) {
  const of = ({ turningTimes }) =>
    2 *
    median(
      Array.from(turningTimes)
        .slice(1)
        .map((t, i) => t - turningTimes[i]),
    );
  const periods = masses.filter(({ turningTimes }) => turningTimes.length > 1).map(of);
  return periods.length ? Math.min(...periods) : NaN;
}

// The period of the excitation; in a run-up or run-down the shortest period.
function periodOfExcitation({ angularFrequency, excitation }) {
  const fastest = angularFrequency?.values.reduce((a, b) => Math.max(a, b), 0) ?? excitation;
  return (2 * Math.PI) / fastest;
}

// Whether the samples of a mass miss its peak by more than `leastSamples` samples per period could.
function missesPeak({ displacement, peak }) {
  if (!displacement || !(peak > 0)) return false;
  const seen = displacement.values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  return seen < peak * Math.cos(Math.PI / leastSamples);
}

// How densely a history samples its motion: {step [s], period [s] or NaN, perPeriod, sparse: whether lines between
// the samples would show another motion, enough: a sufficient number of samples, NaN if not known}.
export function samplingOf(motion) {
  const { kind, time, masses, duration } = motion;
  if (!time || time.values.length < 2)
    return { step: NaN, period: NaN, perPeriod: NaN, sparse: false, enough: NaN };
  const step = (time.values.at(-1) - time.values[0]) / (time.values.length - 1);
  const period = kind === "decay" ? periodOfTurning(motion) : periodOfExcitation(motion);
  const perPeriod = period / step;
  return {
    step,
    period,
    perPeriod,
    sparse: perPeriod < leastSamples || masses.some(missesPeak),
    enough: Math.ceil((goodSamples * duration) / period) + 1,
  };
}

// Turning points above and below their neighbours: {upper: {x, y}, lower: {x, y}}.
export function envelope({ turningTimes, turningPoints }) {
  const upper = { x: [], y: [] },
    lower = { x: [], y: [] };
  turningPoints.forEach((value, i) => {
    const other = i + 1 < turningPoints.length ? turningPoints[i + 1] : turningPoints[i - 1];
    const side = other === undefined || value > other ? upper : lower;
    side.x.push(turningTimes[i]);
    side.y.push(value);
  });
  return { upper, lower };
}

const roundingDecrement = 1e-12; // logarithmic decrements below it are rounding
const roundingPart = 1e-12; // displacements below this part of the largest are rounding

export function isRounding(decrement) {
  return Math.abs(decrement) < roundingDecrement;
}

// Whether a displacement is rounding compared with the turning points.
export function isRoundingOf(value, turningPoints) {
  const largest = turningPoints.reduce((most, point) => Math.max(most, Math.abs(point)), 0);
  return Math.abs(value) <= roundingPart * largest;
}

// Whether a mass never moved from its initial position.
export function isStill({ turningTimes, turningPoints, rest, displacement }, { stopTime }) {
  const [place] = turningPoints;
  if (turningPoints.length !== 1 || turningTimes[0] !== 0 || place !== rest) return false;
  return Number.isFinite(stopTime) || (displacement?.values.every((value) => value === rest) ?? false);
}

// Whether friction holds a mass at rest since its last turning point. Damping alone brings a mass nearer to its rest
// from turn to turn; friction stops the mass there at once.
export function isHeldSinceTurning({ turningPoints, rest }, { mayStop }) {
  const beyond = (value) => value - rest;
  const last = turningPoints.at(-1),
    before = turningPoints.at(-2) ?? NaN;
  return mayStop && last === rest && !isRoundingOf(beyond(before), turningPoints.map(beyond));
}

// Whether the decrements of a mass, computed about zero, measure its decay: the mass swings from one side of zero to
// the other. A single mass does, except where it stops.
export function swingsAboutZero({ turningPoints }, motion) {
  return isOneMode(motion) || turningPoints.every((point, i) => i === 0 || point * turningPoints[i - 1] < 0);
}

// Whether a mass decays in one mode, so that its decrement gives a damping ratio.
export function isOneMode({ masses }) {
  return masses.filter(({ noun }) => noun !== "signal").length === 1;
}

// Whether the decrements end before the cycles do: the rest is rounding.
export function decrementsEndEarly({ decrements, turningPoints }) {
  return decrements.length > 0 && decrements.length < turningPoints.length - 2;
}

// The damping ratio of viscous damping with this logarithmic decrement of a full cycle.
export function dampingRatio(decrement) {
  return decrement / Math.hypot(2 * Math.PI, decrement);
}

// y at `at` by linear interpolation.
export function interpolated(x, y, at) {
  let high = x.findIndex((value) => value >= at);
  if (high < 0) return NaN;
  high = Math.max(1, high);
  return y[high - 1] + ((y[high] - y[high - 1]) * (at - x[high - 1])) / (x[high] - x[high - 1]);
}

// The range of samples, at the start or at the end, in which every mass reverses its motion `turns` times; null if
// the range is more than a quarter of all samples.
export function stretch({ time, masses }, turns, end) {
  const count = time.values.length,
    step = end === "first" ? 1 : -1;
  let longest = 0;
  for (const { velocity } of masses) {
    if (!velocity) return null;
    let seen = 0,
      i = end === "first" ? 1 : count - 2,
      steps = 1;
    for (; seen < turns && i > 0 && i < count - 1; i += step, ++steps) {
      if (velocity.values[i] * velocity.values[i + step] <= 0 && velocity.values[i] !== 0) ++seen;
    }
    longest = Math.max(longest, steps);
  }
  if (longest > count / 4) return null;
  return end === "first" ? { from: 0, to: longest + 1 } : { from: count - 1 - longest, to: count };
}
