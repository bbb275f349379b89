// Regime borders: crossings solved on the grid's edges (group /borders), joined into curves over two axes.

// The crossings within the slice over x and y at the given index of the other axes. Each lies on a grid edge
// along x or along y, at a whole index of the other.  Returns [{key, i, j, alongX}], i and j fractional indices.
export function crossingsOfSlice(crossings, { x, y, index }) {
  return crossings
    .filter(
      (crossing) =>
        crossing.place.every(
          (place, axis) => axis === x || axis === y || Math.abs(place - index[axis]) < 1e-9,
        ) &&
        (crossing.axis === x || crossing.axis === y),
    )
    .map((crossing) => ({
      key: crossing.key,
      i: crossing.place[x],
      j: crossing.place[y],
      alongX: crossing.axis === x,
    }));
}

// The cells that an edge bounds: two, or one at the rim.
function cellsOf({ i, j, alongX }, nx, ny) {
  const column = Math.floor(alongX ? i : Math.round(i)),
    row = Math.floor(alongX ? Math.round(j) : j);
  const cells = alongX
    ? [
        [Math.min(column, nx - 2), row - 1],
        [Math.min(column, nx - 2), row],
      ]
    : [
        [column - 1, Math.min(row, ny - 2)],
        [column, Math.min(row, ny - 2)],
      ];
  return cells.filter(([c, r]) => c >= 0 && r >= 0 && c < nx - 1 && r < ny - 1);
}

const distance = (a, b) => Math.hypot(a.i - b.i, a.j - b.j);

// Joins the crossings of one cell in pairs, the nearest first.
function pairsWithin(points) {
  const left = [...points],
    pairs = [];
  while (left.length > 1) {
    let best = [0, 1];
    for (let a = 0; a < left.length; ++a) {
      for (let b = a + 1; b < left.length; ++b) {
        if (distance(left[a], left[b]) < distance(left[best[0]], left[best[1]])) best = [a, b];
      }
    }
    pairs.push([left[best[0]], left[best[1]]]);
    left.splice(best[1], 1);
    left.splice(best[0], 1);
  }
  return { pairs, left };
}

// Where three regimes meet in a cell, each kind of border has one loose end: all ends are joined at their mean.
function joinLooseEnds(loose) {
  if (loose.length < 2) return [];
  const middle = {
    i: loose.reduce((sum, p) => sum + p.i, 0) / loose.length,
    j: loose.reduce((sum, p) => sum + p.j, 0) / loose.length,
  };
  return loose.map((point) => [point, { ...middle, key: point.key }]);
}

// Pieces of curves end to end.  pieces: pairs of points (the same objects where they meet).
function chained(pieces) {
  const at = new Map();
  const add = (point, piece) => at.set(point, [...(at.get(point) ?? []), piece]);
  for (const piece of pieces) piece.forEach((point) => add(point, piece));
  const used = new Set();
  const walk = (from, piece) => {
    const line = [from];
    for (let next = piece; next && !used.has(next);) {
      used.add(next);
      const to = next[0] === line.at(-1) ? next[1] : next[0];
      line.push(to);
      next = at.get(to).find((other) => !used.has(other));
    }
    return line;
  };
  const ends = [...at]
    .filter(([, joined]) => joined.length === 1)
    .map(([point, joined]) => [point, joined[0]]);
  const lines = ends
    .filter(([, piece]) => !used.has(piece))
    .map(([point, piece]) => (used.has(piece) ? null : walk(point, piece)))
    .filter(Boolean);
  for (const piece of pieces) if (!used.has(piece)) lines.push(walk(piece[0], piece));
  return lines;
}

// Border curves of one contact over axes x and y, the other axes at `index`: [{key, points: [[i, j], ...]}],
// key "non_stop|stuck"; i, j fractional indices along x and y.
export function borderCurves(crossings, { x, y, index, nx, ny }) {
  const cells = new Map();
  for (const point of crossingsOfSlice(crossings, { x, y, index })) {
    for (const [column, row] of cellsOf(point, nx, ny)) {
      const cell = `${column},${row}`;
      cells.set(cell, [...(cells.get(cell) ?? []), point]);
    }
  }
  const pieces = new Map();
  const add = (pair) => pieces.set(pair[0].key, [...(pieces.get(pair[0].key) ?? []), pair]);
  for (const points of cells.values()) {
    const loose = [];
    for (const key of new Set(points.map((point) => point.key))) {
      const { pairs, left } = pairsWithin(points.filter((point) => point.key === key));
      pairs.forEach(add);
      loose.push(...left);
    }
    joinLooseEnds(loose).forEach(add);
  }
  return [...pieces].flatMap(([key, pairs]) =>
    chained(pairs).map((line) => ({ key, points: line.map(({ i, j }) => [i, j]) })),
  );
}
