// The page of a map: what is missing, the map itself, recorded orbits, resonances, axes, quantities not in the page.
import { coordinateLabel } from "../axes.js";
import { element, section, table } from "../parts/elements.js";
import { failedPoints, missingPoints } from "../parts/missing_points.js";
import { isMissing } from "../record.js";
import { scatterFigures, scatterSection } from "./scatter.js";
import { explorerSections } from "./explorer.js";
import { allMapFigures, pointsAcross } from "./map_figures.js";
import { allOrbitFigures, orbitSection } from "./orbits.js";
import { allProfileFigures, modeSection } from "./profile.js";
import { resonanceFigures, resonanceSection } from "./resonance.js";
import { firstState } from "./sweep_state.js";

function facts(record) {
  const { map } = record;
  const axes = map.axes.map((axis) => [
    axis.coordinates.map(coordinateLabel).join("; "),
    axis.size,
    axis.coordinates
      .map(({ values }) =>
        values.length > 1
          ? `${Number(values[0].toPrecision(6))} \u2026 ${Number(values.at(-1).toPrecision(6))}`
          : values[0],
      )
      .join("; "),
  ]);
  return section(
    "Axes",
    element("p", { class: "note" }, map.points === 1 ? "1 point" : `${map.points} points`),
    table(["axis", "points", "from \u2026 to"], axes, { numeric: [1] }),
  );
}

const mostNamed = 24; // quantities named at once

// The names, those of many behind a click.
function alsoHeld(names) {
  const text = (some) => `The file also holds ${some.join(", ")}.`;
  if (names.length <= mostNamed) return element("p", {}, text(names));
  const summary = `The file also holds ${names.length} more quantities`;
  return element("details", {}, element("summary", {}, summary), element("p", {}, text(names)));
}

function leftOut(record) {
  const { leftOut: names } = record.map;
  if (!names.length) return null;
  const carried = record.map.variables.map(({ name }) => name);
  const chosen = [...(carried.length > mostNamed ? [] : carried), names[0].name].join(",");
  return section(
    "Not in this page",
    alsoHeld(names.map(({ name }) => name)),
    element(
      "p",
      { class: "note" },
      `To include ${names[0].name}, use: `,
      element("code", {}, `frahm report ${record.file} --quantities ${chosen}`),
      " or [report] quantities in the study.",
    ),
  );
}

function hasNumbers({ variables }) {
  return variables.some((variable) => variable.values.some((value) => !isMissing(variable, value)));
}

export function sweepParts(record) {
  return [
    ...missingPoints(record),
    ...(hasNumbers(record.map) ? scatterSection(record) : []),
    ...(hasNumbers(record.map) ? explorerSections(record) : []),
    modeSection(record),
    orbitSection(record),
    resonanceSection(record),
    failedPoints(record),
    facts(record),
    leftOut(record),
  ].filter(Boolean);
}

function figuresOfPoints(record) {
  const state = firstState(record);
  return [
    ...allMapFigures(record.map, state),
    ...allProfileFigures(record, state, pointsAcross(record.map, state)),
  ];
}

export function sweepFigures(record) {
  return [
    ...(hasNumbers(record.map) ? figuresOfPoints(record) : []),
    ...(hasNumbers(record.map) ? scatterFigures(record) : []),
    ...allOrbitFigures(record),
    ...resonanceFigures(record),
  ];
}
