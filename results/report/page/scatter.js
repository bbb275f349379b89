// What /statistics and /tornado say of a map with an axis of samples, at a point of its other axes.

const number = (text) => Number(text.replace("_", "."));

// The quantiles recorded of a quantity, the lowest first: [{share, suffix}].
function quantilesOf(group, { name }) {
  return group.columns
    .map((column) => column.name)
    .filter((column) => column.startsWith(`${name}_q`))
    .map((column) => column.slice(name.length))
    .filter((suffix) => /^_q\d+(_\d+)?$/.test(suffix))
    .map((suffix) => ({ suffix, share: number(suffix.slice(2)) / 100 }))
    .sort((a, b) => a.share - b.share);
}

// The numbers of a group at a point of the map, which has the samples besides.
class BesideSamples {
  constructor(map, group) {
    this.group = group;
    this.axes = map.axes.map((_, a) => a).filter((a) => a !== map.samples);
    this.sizes = this.axes.map((a) => map.axes[a].size);
  }
  value(name, index) {
    const offset = this.axes.reduce((sum, a, i) => sum * this.sizes[i] + index[a], 0);
    return this.group.values(name)?.[offset] ?? NaN;
  }
  // At all points of an axis of the map, through a point.
  line(name, index, axis) {
    const count = this.sizes[this.axes.indexOf(axis)];
    return Float64Array.from({ length: count }, (_, i) =>
      this.value(
        name,
        index.map((at, a) => (a === axis ? i : at)),
      ),
    );
  }
}

// {map, quantities: [{variable, quantiles}], statistics, tornado (or null), parameters}; null without samples.
export function scatterOf({ map, groups }) {
  const group = groups.get("statistics");
  if (map?.samples === null || !group) return null;
  const quantities = map.variables
    .filter(({ name }) => group.has(`${name}_mean`))
    .map((variable) => ({ variable, quantiles: quantilesOf(group, variable) }));
  if (quantities.length === 0) return null;
  const tornado = groups.get("tornado");
  return {
    map,
    quantities,
    statistics: new BesideSamples(map, group),
    tornado: tornado ? new BesideSamples(map, tornado) : null,
    parameters: map.axes[map.samples].coordinates
      .map(({ name }) => name)
      .filter((name) => map.parameters.has(name)),
  };
}

// {mean, deviation, samples, quantiles: [{share, value, low, high}]} of a quantity at a point.
export function scatterAt({ statistics }, { variable: { name }, quantiles }, index) {
  const at = (suffix) => statistics.value(name + suffix, index);
  return {
    mean: { value: at("_mean"), low: at("_mean_low"), high: at("_mean_high") },
    deviation: at("_deviation"),
    samples: at("_samples"),
    quantiles: quantiles.map(({ share, suffix }) => ({
      share,
      value: at(suffix),
      low: at(`${suffix}_low`),
      high: at(`${suffix}_high`),
    })),
  };
}

// What each parameter changes at a point, the most first: [{parameter, change, share}]; empty without derivatives.
export function tornadoAt({ tornado, parameters }, { variable: { name } }, index) {
  if (!tornado) return [];
  return parameters
    .map((parameter) => ({
      parameter,
      change: tornado.value(`${name}_by_${parameter}`, index),
      share: tornado.value(`${name}_share_${parameter}`, index),
    }))
    .filter(({ change }) => Number.isFinite(change))
    .sort((a, b) => Math.abs(b.change) - Math.abs(a.change));
}

// The point at which the highest quantile (without quantiles the mean) is largest.
export function worstPoint({ map, statistics }, { variable, quantiles }) {
  const values = statistics.group.values(variable.name + (quantiles.at(-1)?.suffix ?? "_mean"));
  let worst = 0;
  values.forEach((value, i) => {
    if (Math.abs(value) > Math.abs(values[worst]) || Number.isNaN(values[worst])) worst = i;
  });
  const index = map.axes.map(() => 0);
  for (let i = statistics.axes.length - 1; i >= 0; --i) {
    index[statistics.axes[i]] = worst % statistics.sizes[i];
    worst = Math.floor(worst / statistics.sizes[i]);
  }
  return index;
}
