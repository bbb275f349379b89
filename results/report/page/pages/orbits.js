// The recorded orbits: one at a time on the page, all of them for papers.
import { endsOfMany, massesOf, orbitFigures, orbitLabel, orbitSamples } from "../figures/orbit_figures.js";
import { choice, choiceOfMany } from "../parts/controls.js";
import { element, section } from "../parts/elements.js";
import { figureCard } from "../parts/figure_card.js";

function countOf(group) {
  return group?.values("row_start")?.length ?? 0;
}

// portrait: the mass whose phase portrait is among them; undefined: those of few masses, or of the first and the last.
function figuresOf(group, k, portrait) {
  return orbitFigures(orbitSamples(group, k), orbitLabel(group, k), `_${k + 1}`, portrait && [portrait]);
}

// null if there are none.
export function orbitSection(record) {
  const group = record.groups.get("orbits");
  const count = countOf(group);
  if (!count) return null;
  const cards = element("div", { class: "cards" });
  const masses = massesOf(orbitSamples(group, 0)),
    ends = endsOfMany(masses);
  const areMany = ends.length < masses.length;
  const shown = { orbit: 0, portrait: areMany ? ends[0] : undefined };
  const show = (change) => {
    Object.assign(shown, change);
    const figures = figuresOf(group, shown.orbit, shown.portrait);
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
  show({});
  const portraits = areMany
    ? choiceOfMany("phase portrait", masses, ends, ends[0], (portrait) => show({ portrait }))
    : [];
  const list = choice(
    "orbit",
    Array.from({ length: count }, (_, k) => [k, orbitLabel(group, k)]),
    0,
    (k) => show({ orbit: Number(k) }),
  );
  return section("Orbits kept", element("div", { class: "controls" }, list, ...portraits), cards);
}

export function allOrbitFigures(record) {
  const group = record.groups.get("orbits");
  return Array.from({ length: countOf(group) }, (_, k) => figuresOf(group, k)).flat();
}
