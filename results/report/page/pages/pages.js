// The parts of a result's page: those of its map, and those of each of its groups.
import { branchFigures, branchParts } from "./branches.js";
import { tuningFigures, tuningParts } from "./tuning.js";
import { identificationFigures, identificationParts } from "./identification.js";
import { crankFigures, crankParts } from "./crank.js";
import { hasMotion, motionFigures, motionParts } from "./motion.js";
import { sweepFigures, sweepParts } from "./sweep.js";

// parts(record): elements of the page.  figures(record): figures without interaction, for papers.
const kinds = [
  { has: (record) => record.map !== null, parts: sweepParts, figures: sweepFigures },
  { has: (record) => record.groups.has("optimum"), parts: tuningParts, figures: tuningFigures },
  {
    has: (record) => record.groups.has("identification"),
    parts: identificationParts,
    figures: identificationFigures,
  },
  {
    has: (record) => record.map === null && record.groups.has("branches"),
    parts: branchParts,
    figures: branchFigures,
  },
  { has: hasMotion, parts: motionParts, figures: motionFigures },
  { has: (record) => record.groups.has("crank"), parts: crankParts, figures: crankFigures },
];

export function partsOf(record) {
  return kinds.filter(({ has }) => has(record)).flatMap(({ parts }) => parts(record));
}

export function figuresOf(record) {
  return kinds.filter(({ has }) => has(record)).flatMap(({ figures }) => figures(record));
}
