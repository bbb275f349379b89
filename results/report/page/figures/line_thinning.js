// Thins long curves without a visible change: no extreme is lost, no point is off by more than a tolerance.

// Reduces a history to its first, least, greatest and last point in each of `columns` pixel columns. x rises.
// Returns {x, y}: the history itself if it has at most four points a column.
export function thinnedHistory(x, y, columns) {
  if (x.length <= 4 * columns) return { x, y };
  const low = x[0],
    width = (x[x.length - 1] - low) / columns;
  const kept = [];
  for (let from = 0, to; from < x.length; from = to) {
    const column = Math.floor((x[from] - low) / width);
    let least = from,
      greatest = from;
    for (to = from; to < x.length && Math.floor((x[to] - low) / width) === column; ++to) {
      if (!(y[to] >= y[least])) least = to;
      if (!(y[to] <= y[greatest])) greatest = to;
    }
    kept.push(...new Set([from, Math.min(least, greatest), Math.max(least, greatest), to - 1]));
  }
  return { x: kept.map((i) => x[i]), y: kept.map((i) => y[i]) };
}

const angleOf = ([x, y]) => Math.atan2(y, x);

function turned(angle, from) {
  const turn = angle - from;
  return turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI));
}

// Thins a path of any shape; the omitted points lie within `tolerance` of the rest. scale: pixels per unit of x and y.
// A piece goes straight on while one direction passes all points since the last one retained and none turns back.
export function thinnedPath(x, y, scale, tolerance) {
  const at = (i) => [x[i] * scale.x, y[i] * scale.y];
  const kept = [0];
  let from = at(0),
    low = -Infinity,
    high = Infinity,
    far = 0,
    ahead = null;
  const restart = (i) => {
    kept.push(i);
    from = at(i);
    low = -Infinity;
    high = Infinity;
    far = 0;
    ahead = null;
  };
  const passes = (i) => {
    const place = at(i),
      away = [place[0] - from[0], place[1] - from[1]],
      distance = Math.hypot(...away);
    if (!(distance >= far)) return false;
    far = distance;
    if (distance <= tolerance) return true;
    const spread = Math.asin(tolerance / distance);
    ahead ??= angleOf(away);
    const turn = turned(angleOf(away), ahead);
    if (turn < low || turn > high) return false;
    low = Math.max(low, turn - spread);
    high = Math.min(high, turn + spread);
    return true;
  };
  for (let i = 1; i < x.length; ++i) {
    if (passes(i)) continue;
    if (kept.at(-1) !== i - 1) {
      restart(i - 1);
      if (passes(i)) continue;
    }
    restart(i);
  }
  if (x.length > 1 && kept.at(-1) !== x.length - 1) kept.push(x.length - 1);
  return { x: kept.map((i) => x[i]), y: kept.map((i) => y[i]) };
}
