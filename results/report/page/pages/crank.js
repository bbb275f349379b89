// The part of a page about the cranks of the study.
import { cranksOf, largestErrors } from "../crank.js";
import { crankErrorFigure, crankMotionFigure } from "../figures/crank_figures.js";
import { section, table } from "../parts/elements.js";
import { figureCards } from "../parts/figure_cards.js";
import { numberText, quantityText, words } from "../units.js";

function errorTable(cranks) {
  const rows = cranks.flatMap((crank) =>
    crank.cuts.map((cut) => {
      const { length, relative } = largestErrors(crank, cut);
      return [
        words(crank.name),
        numberText(cut.order),
        quantityText(length, crank.motion.unit, 4),
        `${numberText(100 * relative, 4)} %`,
      ];
    }),
  );
  return rows.length
    ? [
        table(["node driven", "series to order", "largest error", "largest relative error"], rows, {
          numeric: [1, 2, 3],
        }),
      ]
    : [];
}

export function crankParts(record) {
  const cranks = cranksOf(record);
  return cranks.length
    ? [section("Crank", ...errorTable(cranks), ...figureCards(crankFigures(record), record))]
    : [];
}

export function crankFigures(record) {
  return cranksOf(record).flatMap((crank) => [
    crankMotionFigure(crank),
    ...(crank.cuts.length ? [crankErrorFigure(crank)] : []),
  ]);
}
