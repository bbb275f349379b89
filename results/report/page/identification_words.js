// What an identification means, in sentences of numbers.
import { symbolText } from "./axes.js";
import { certainty, closestPair } from "./identification.js";
import { numberText, shownUnit, words } from "./units.js";

const digits = 4;
const mostNamed = 6; // estimates told one by one; the table has all
const hardlyApart = 0.95; // correlation from which two estimates are hardly told apart
const asOne = 1 - 1e-6; // and from which one follows from the other

// "26.51 N s/m (95 %: 26.42 to 26.59)".
export function estimateText(estimate) {
  const { value, low, high, unit } = estimate;
  if (Number.isNaN(value)) return "not determined by the data";
  const { factor, text } = shownUnit(unit, [value, low, high]);
  const inUnit = (number) => numberText(number * factor, digits),
    after = text ? ` ${text}` : "";
  switch (certainty(estimate)) {
    case "determined":
      return `${inUnit(value)}${after} (95 %: ${inUnit(low)} to ${inUnit(high)})`;
    case "undetermined":
      return `${inUnit(value)}${after}, which the data do not determine`;
    default:
      return `${inUnit(value)}${after} (no interval: no more data than unknowns)`;
  }
}

function estimateSentences({ estimates }) {
  const told = estimates
    .slice(0, mostNamed)
    .map((estimate) => `${symbolText(estimate.name)} = ${estimateText(estimate)}`);
  if (told.length === 0) return [];
  return [
    `${told.join("; ")}.`,
    ...(estimates.length > mostNamed ? [`${estimates.length - mostNamed} more stand in the table.`] : []),
  ];
}

function qualitySentences({ quality }) {
  const known = quality.filter(({ nrmse }) => Number.isFinite(nrmse));
  if (known.length === 0) return [];
  const each = known.map(({ record, nrmse }) => `${numberText(nrmse, digits)} % of ${words(record)}`);
  return [`The model reproduces ${each.join(", ")} (NRMSE fit; 100 % is without any residual).`];
}

function doubtSentences({ estimates }) {
  const sentences = [];
  const crossing = estimates.filter(
    (estimate) => certainty(estimate) === "determined" && estimate.low < 0 && estimate.high > 0,
  );
  if (crossing.length)
    sentences.push(`Not told from zero at 95 %: ${crossing.map(({ name }) => symbolText(name)).join(", ")}.`);
  const pair = closestPair(estimates);
  if (pair && Math.abs(pair.value) >= hardlyApart && Math.abs(pair.value) < asOne) {
    sentences.push(
      `${symbolText(pair.a)} and ${symbolText(pair.b)} are correlated (${numberText(pair.value, digits)}): the ` +
        `data hardly tell them apart.`,
    );
  }
  return sentences;
}

function rowSentences({ rows }) {
  if (!rows) return [];
  return rows.columns.map(({ name, unit, values }) => {
    const known = Array.from(values).filter(Number.isFinite);
    const { factor, text } = shownUnit(unit, known);
    const end = (value) => numberText(value * factor, digits);
    if (known.length === 0) return `${symbolText(name)}: none of ${values.length} rows has a number.`;
    return (
      `${symbolText(name)} lies between ${end(Math.min(...known))} and ` +
      `${end(Math.max(...known))}${text ? ` ${text}` : ""} in ${known.length} of ${values.length} rows.`
    );
  });
}

// Paragraphs of sentences: [[sentence, ...], ...].
export function whatItMeans(identification) {
  return [
    estimateSentences(identification),
    rowSentences(identification),
    [...qualitySentences(identification), ...doubtSentences(identification)],
  ].filter((paragraph) => paragraph.length > 0);
}

export function outcomeWarning({ outcome }) {
  if (outcome === "converged") return "";
  return outcome === "not_converged"
    ? "This identification did not converge: its estimates are where it stopped, and their intervals tell nothing."
    : "It is not known how this identification ended.";
}
