// The part of a page that tells what its crank does.
import { cranksOf, largestError } from "../crank.js";
import { crankErrorFigure, crankMotionFigure } from "../figures/crank_figures.js";
import { section, table } from "../parts/elements.js";
import { figureCards } from "../parts/figure_cards.js";
import { numberText, quantityText, words } from "../units.js";

function errorTable(cranks) {
  const rows = cranks.flatMap((crank) => crank.cuts.map((cut) => {
    const error = largestError(crank, cut);
    return [words(crank.name), numberText(cut.order), quantityText(error * crank.length, crank.motion.unit, 4), `${numberText(100 * error, 4)} %`];
  }));
  return rows.length ? [table(["driven by a crank", "series to order", "largest error", `relative to ${cranks[0].isThrow ? "the throw" : "the largest displacement"}`], rows, { numeric: [1, 2, 3] })] : [];
}

export function crankParts(record) {
  const cranks = cranksOf(record);
  return cranks.length ? [section("Crank", ...errorTable(cranks), ...figureCards(crankFigures(record), record))] : [];
}

export function crankFigures(record) {
  return cranksOf(record).flatMap((crank) => [crankMotionFigure(crank), ...(crank.cuts.length ? [crankErrorFigure(crank)] : [])]);
}
