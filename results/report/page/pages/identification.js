// The page of an identification: estimates with their intervals, data against model, residuals, correlations.
import { symbolText } from "../axes.js";
import { correlationFigure } from "../figures/correlation_figure.js";
import { fitFigures } from "../figures/fit_figures.js";
import { certainty, hasFreedom, identificationOf, residualRms } from "../identification.js";
import {
  correlationText,
  intervalText,
  noteSentence,
  outcomeWarning,
  whatItMeans,
} from "../identification_words.js";
import { element, section, table } from "../parts/elements.js";
import { figureCards } from "../parts/figure_cards.js";
import { meaningSection } from "../parts/meaning.js";
import { numberText, quantityText, shownUnit, withUnit, words } from "../units.js";

const intervalWords = { undetermined: "not determined", untold: "no interval: no more data than unknowns" };

// Value, interval and error of an estimate in one unit.
function estimateRow(estimate) {
  const { name, unit, meaning, value, low, high, standardError, degreesOfFreedom } = estimate;
  const { factor, text } = shownUnit(unit, [value]);
  const shown = (number) => numberText(number * factor);
  const state = certainty(estimate);
  const interval =
    state === "determined" ? intervalText({ value, low, high, factor }, 6) : intervalWords[state];
  return [
    withUnit(symbolText(name), text),
    Number.isNaN(value) ? "not determined" : shown(value),
    interval,
    state === "undetermined" ? "\u2013" : numberText(standardError * factor, 4),
    numberText(degreesOfFreedom, 5),
    meaning === `fitted ${name}` ? "parameter of the study" : meaning,
  ];
}

function estimatesTable(estimates) {
  const head = ["estimate", "value", "95 % interval", "standard error", "degrees of freedom", "meaning"];
  return table(head, estimates.map(estimateRow), { numeric: [1, 2, 3, 4] });
}

function qualityTable(identification) {
  const { quality, series } = identification;
  const fitText = (record, nrmse) =>
    hasFreedom(identification, record) ? numberText(nrmse) : "\u2013 (no more data than unknowns)";
  const rows = quality.flatMap(({ record, nrmse }) => {
    const own = series.filter((one) => one.record === record);
    return [
      [
        words(record),
        own.length === 1 ? words(own[0].quantity) : "all quantities",
        fitText(record, nrmse),
        own.length === 1 ? quantityText(residualRms(own[0]), own[0].measured.unit, 4) : "",
      ],
      ...(own.length > 1
        ? own.map((one) => [
            "",
            words(one.quantity),
            numberText(one.nrmse),
            quantityText(residualRms(one), one.measured.unit, 4),
          ])
        : []),
    ];
  });
  return rows.length
    ? [
        table(["record", "quantity", "NRMSE fit (%)", "root mean square of the residual"], rows, {
          numeric: [2, 3],
        }),
      ]
    : [];
}

function correlationTable(estimates) {
  if (!estimates.some(({ correlation }) => correlation.length > 1)) return [];
  const head = ["", ...estimates.map(({ name }) => symbolText(name))];
  const rows = estimates.map(({ name, correlation }) => [
    symbolText(name),
    ...correlation.map(({ value }) => correlationText(value)),
  ]);
  return [
    element(
      "details",
      {},
      element("summary", {}, "Correlations as numbers"),
      table(head, rows, { numeric: head.map((_, i) => i).slice(1) }),
    ),
  ];
}

function rowsTable({ rows }) {
  if (!rows) return [];
  const shown = rows.columns.map(({ unit, values }) => shownUnit(unit, values));
  const head = ["row", ...rows.columns.map(({ name }, c) => withUnit(symbolText(name), shown[c].text))];
  const body = rows.labels.map((label, i) => [
    label,
    ...rows.columns.map(({ values }, c) => numberText(values[i] * shown[c].factor)),
  ]);
  const meanings = rows.columns.map(({ name, long_name }) => `${symbolText(name)}: ${long_name}`).join("; ");
  return [
    section(
      "Rows",
      element("p", { class: "note" }, `${meanings}.`),
      table(head, body, { numeric: head.map((_, i) => i).slice(1) }),
    ),
  ];
}

const counted = (count, thing) => `${numberText(count, 5)} ${thing}${count === 1 ? "" : "s"}`;

// Rows computed one by one have no fit.
function methodText({ method, group, outcome, estimates }) {
  const freedom = group.number("degrees_of_freedom");
  const fit = [
    `${counted(freedom, "degree").replace(/(degrees?)$/, "$1 of freedom of the residuals")}`,
    counted(group.number("iterations"), "iteration"),
  ];
  const facts = [`method ${words(method)}`, words(outcome), ...(estimates.length ? fit : [])];
  return element("p", { class: "note" }, `${facts.join("; ")}.`);
}

function hasCorrelations({ estimates }) {
  return estimates.some(({ correlation }) => correlation.length > 1);
}

export function identificationParts(record) {
  const found = identificationOf(record),
    warning = outcomeWarning(found);
  return [
    ...[warning, ...found.notes.map(noteSentence)]
      .filter(Boolean)
      .map((text) => element("p", { class: "warning" }, text)),
    meaningSection(whatItMeans(found), methodText(found)),
    ...(found.estimates.length ? [section("Estimates", estimatesTable(found.estimates))] : []),
    ...(found.first.length
      ? [
          section(
            "First stage",
            element("p", { class: "note" }, "Where the fit started."),
            estimatesTable(found.first),
          ),
        ]
      : []),
    ...rowsTable(found),
    ...(found.series.length
      ? [section("Data against model", ...qualityTable(found), ...figureCards(fitFigures(found), record))]
      : []),
    ...(hasCorrelations(found)
      ? [
          section(
            "Correlations",
            ...figureCards([correlationFigure(found.estimates)], record),
            ...correlationTable(found.estimates),
          ),
        ]
      : []),
  ];
}

export function identificationFigures(record) {
  const found = identificationOf(record);
  return [...fitFigures(found), ...(hasCorrelations(found) ? [correlationFigure(found.estimates)] : [])];
}
