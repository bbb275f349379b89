// A pointer over a response map: shows the point below it, and picks it at a click.
import { axisScale, nearest } from "../axes.js";
import { element } from "./elements.js";

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
}
