// The motion that each crank of the study gives its node, from the group "crank": exact, and by its series cut after
// an order.

// [{name, angle, motion, cuts: [{order, series, error}]}]; errors are relative to the distance l_AC from the crank's
// bearing to the driven node.
export function cranksOf(record) {
  const group = record.groups.get("crank");
  return group.columns
    .filter(({ name }) => name.endsWith("_motion"))
    .map((motion) => {
      const name = motion.name.slice(0, -"_motion".length),
        start = `${name}_taylor_`;
      const cuts = group.columns
        .filter((column) => column.name.startsWith(start) && group.has(`${column.name}_error`))
        .map((series) => ({
          order: Number(series.name.slice(start.length)),
          series,
          error: group.column(`${series.name}_error`),
        }));
      return { name, angle: group.column("angle"), motion, cuts };
    });
}

const largest = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);

// The largest error of a cut: {length in the motion's unit, relative}.
export function largestErrors({ motion }, { series, error }) {
  return {
    length: largest(motion.values.map((value, i) => series.values[i] - value)),
    relative: largest(error.values),
  };
}
