// The recorded orbits: one at a time on the page, all of them for papers.
import { orbitFigures, orbitLabel, orbitSamples } from "../figures/orbit_figures.js";
import { choice } from "../parts/controls.js";
import { element, section } from "../parts/elements.js";
import { figureCard } from "../parts/figure_card.js";

function countOf(group) {
  return group?.values("row_start")?.length ?? 0;
}

function figuresOf(group, k) {
  return orbitFigures(orbitSamples(group, k), orbitLabel(group, k), `_${k + 1}`);
}

// null if there are none.
export function orbitSection(record) {
  const group = record.groups.get("orbits");
  const count = countOf(group);
  if (!count) return null;
  const cards = element("div", { class: "cards" });
  const show = (k) => {
    const figures = figuresOf(group, k);
    cards.replaceChildren(
      ...(figures.length
        ? figures.map((figure) => figureCard(figure, record).card)
        : [
            element(
              "p",
              { class: "warning" },
              "This point has no orbit: it failed, or has no bounded response.",
            ),
          ]),
    );
  };
  show(0);
  const list = choice(
    "orbit",
    Array.from({ length: count }, (_, k) => [k, orbitLabel(group, k)]),
    0,
    (k) => show(Number(k)),
  );
  return section("Orbits kept", element("div", { class: "controls" }, list), cards);
}

export function allOrbitFigures(record) {
  const group = record.groups.get("orbits");
  return Array.from({ length: countOf(group) }, (_, k) => figuresOf(group, k)).flat();
}
