// The motion that a crank gives a node, read from the group /crank: exact, and by its series cut after an order.

// Each node that a crank drives: {name, angle, motion, cuts: [{order, column}], length: what errors are relative to}.
export function cranksOf(record) {
  const group = record.groups.get("crank"), angle = group.column("angle");
  return group.columns.filter(({ name, dimension }) => name.endsWith("_motion") && dimension === angle?.dimension).map((motion) => {
    const name = motion.name.slice(0, -"_motion".length);
    const throwLength = group.number(`${name}_throw`);
    const cuts = group.columns.filter((column) => column.name.startsWith(`${name}_taylor_`))
      .map((column) => ({ order: Number(column.name.slice(`${name}_taylor_`.length)), column }));
    const largest = motion.values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
    return { name, angle, motion, cuts, length: Number.isFinite(throwLength) ? throwLength : largest, isThrow: Number.isFinite(throwLength) };
  });
}

// What a cut misses, relative to the length.
export function cutErrors({ motion, length }, { column }) {
  return Float64Array.from(motion.values, (value, i) => Math.abs(column.values[i] - value) / length);
}

export function largestError(crank, cut) {
  return cutErrors(crank, cut).reduce((most, value) => Math.max(most, value), 0);
}
