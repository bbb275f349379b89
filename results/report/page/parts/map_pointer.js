// A pointer over a response map: shows the point below it, and picks it at a click or tap; arrow keys move the point.
import { axisScale, axisText, nearest } from "../axes.js";
import { element } from "./elements.js";

const far = 10; // points that an arrow key moves by with Shift

// The next point along an axis, to the right or up as drawn: larger values.
function moved(map, state, axis, steps) {
  const { values } = map.axes[axis].coordinates[state.coordinates[axis]];
  const index = [...state.index],
    towards = values.at(-1) < values[0] ? -steps : steps;
  index[axis] = Math.max(0, Math.min(values.length - 1, index[axis] + towards));
  return index;
}

// The chosen point moves with the arrow keys; what it is is told beside the map.
function followKeys(shown, map, state, pick) {
  const told = element("p", { class: "note", role: "status" });
  shown.card.append(told);
  shown.plot.tabIndex = 0;
  shown.plot.setAttribute("role", "group");
  shown.plot.setAttribute("aria-label", "response map: the arrow keys move the chosen point");
  shown.plot.addEventListener("keydown", (event) => {
    const ways = {
      ArrowLeft: [state.x, -1],
      ArrowRight: [state.x, 1],
      ArrowDown: [state.y, -1],
      ArrowUp: [state.y, 1],
    };
    const way = ways[event.key];
    if (!way) return;
    event.preventDefault();
    const index = moved(map, state, way[0], way[1] * (event.shiftKey ? far : 1));
    pick(index, false);
    told.textContent = `Point: ${map.axes.map((axis, a) => axisText(map, axis, index[a])).join(", ")}`;
  });
}

// shown: of figureCard; state: the map's; describe(index): an element; pick(index, add).
export function followPointer(shown, map, state, describe, pick) {
  const tip = element("div", { class: "tip", hidden: true });
  const coordinate = (axis) => map.axes[axis].coordinates[state.coordinates[axis]];
  const indexAt = (event) => {
    const box = shown.svg.getBoundingClientRect();
    const scale = shown.svg.viewBox.baseVal.width / box.width;
    const x = (event.clientX - box.left) * scale,
      y = (event.clientY - box.top) * scale;
    const scales = { x: shown.svg.scale("x"), y: shown.svg.scale("y") };
    const within = (value, [a, b]) => value >= Math.min(a, b) && value <= Math.max(a, b);
    if (!within(x, scales.x.range) || !within(y, scales.y.range)) return null;
    const index = [...state.index];
    for (const [axis, place, name] of [
      [state.x, x, "x"],
      [state.y, y, "y"],
    ]) {
      const { values } = coordinate(axis);
      index[axis] = nearest(values, scales[name].invert(place), axisScale(values));
    }
    return index;
  };
  const hide = () => {
    tip.hidden = true;
  };
  shown.plot.addEventListener("pointermove", (event) => {
    const index = indexAt(event);
    if (!index) return hide();
    tip.replaceChildren(describe(index));
    if (!tip.isConnected) shown.plot.append(tip);
    tip.hidden = false;
    const box = shown.plot.getBoundingClientRect();
    const left = event.clientX - box.left,
      right = left > box.width / 2;
    tip.style.left = right ? "auto" : `${left + 16}px`;
    tip.style.right = right ? `${box.width - left + 16}px` : "auto";
    tip.style.top = `${Math.max(0, event.clientY - box.top - tip.offsetHeight / 2)}px`;
  });
  shown.plot.addEventListener("pointerleave", hide);
  shown.plot.addEventListener("click", (event) => {
    const index = indexAt(event);
    if (index) pick(index, event.shiftKey);
  });
  followKeys(shown, map, state, pick);
}
