// The results of an identification as sentences.
import { symbolText } from "./axes.js";
import { certainty, closePairs, hasFreedom } from "./identification.js";
import { numberText, sentence, shownUnit, words } from "./units.js";

const digits = 4,
  mostDigits = 10;
const mostNamed = 6; // estimates listed one by one; the table has all
const hardlyApart = 0.95; // correlation from which two estimates can hardly be separated
const mostPairs = 3; // of such estimates listed
const roundingPart = 1e-12; // of a value: narrower intervals are rounding
const noCorrelation = 1e-9; // below it is rounding

// Digits that a value needs to show its interval; 0 where the interval is rounding.
function neededDigits(value, low, high) {
  const half = (high - low) / 2;
  const size = Math.max(Math.abs(value), half);
  return half > roundingPart * size ? Math.ceil(Math.log10(size / half)) + 2 : 0;
}

// "26.42 to 26.59", or "\u00b10.0077" where the ends would need more than `places` digits.
export function intervalText({ value, low, high, factor }, places) {
  const needed = neededDigits(value, low, high);
  if (needed === 0) return "only rounding";
  if (needed <= places + 1)
    return `${numberText(low * factor, places)} to ${numberText(high * factor, places)}`;
  return `\u00b1${numberText(((high - low) / 2) * factor, 2)}`;
}

// "26.51 N s/m (95 %: 26.42 to 26.59)".
export function estimateText(estimate) {
  const { value, low, high, unit } = estimate;
  if (Number.isNaN(value)) return "not determined by the data";
  const { factor, text } = shownUnit(unit, [value, low, high]);
  const after = text ? ` ${text}` : "";
  const inUnit = (places) => `${numberText(value * factor, places)}${after}`;
  switch (certainty(estimate)) {
    case "determined": {
      const places = Math.min(mostDigits, Math.max(digits, neededDigits(value, low, high)));
      return `${inUnit(places)} (95 %: ${intervalText({ value, low, high, factor }, digits)})`;
    }
    case "undetermined":
      return `${inUnit(digits)}, which the data do not determine`;
    default:
      return `${inUnit(digits)} (no interval: no more data than unknowns)`;
  }
}

// A correlation with enough digits to differ from one; rounding is written as zero.
export function correlationText(value, places = digits) {
  if (Math.abs(value) < noCorrelation) return "0";
  const apart = 1 - Math.abs(value);
  return numberText(value, apart > 1e-12 ? Math.max(places, Math.ceil(-Math.log10(apart))) : places);
}

function estimateSentences({ estimates }) {
  const told = estimates.slice(0, mostNamed).map((estimate) => {
    const is = Number.isNaN(estimate.value) ? "is" : "=";
    return `${symbolText(estimate.name)} ${is} ${estimateText(estimate)}`;
  });
  if (told.length === 0) return [];
  return [
    `${told.join("; ")}.`,
    ...(estimates.length > mostNamed ? [`${estimates.length - mostNamed} more are in the table.`] : []),
  ];
}

function qualitySentences(identification) {
  const known = identification.quality.filter(
    ({ record, nrmse }) => Number.isFinite(nrmse) && hasFreedom(identification, record),
  );
  if (known.length === 0) return [];
  const each = known.map(({ record, nrmse }) => `${numberText(nrmse, digits)} % of ${words(record)}`);
  return [`The model reproduces ${each.join(", ")} (NRMSE fit; 100 % means no residual).`];
}

function doubtSentences(identification) {
  const { estimates } = identification;
  const sentences = [];
  const crossing = estimates.filter(
    (estimate) => certainty(estimate) === "determined" && estimate.low < 0 && estimate.high > 0,
  );
  if (crossing.length)
    sentences.push(`Not distinguished from zero at 95 %: ${crossing.map(({ name }) => symbolText(name)).join(", ")}.`);
  const pairs = closePairs(identification, hardlyApart);
  if (pairs.length) {
    const told = pairs
      .slice(0, mostPairs)
      .map(
        ({ a, b, value }) => `${symbolText(a)} and ${symbolText(b)} (correlation ${correlationText(value)})`,
      );
    const more = pairs.length > mostPairs ? `; ${pairs.length - mostPairs} more pairs are listed below` : "";
    sentences.push(`The data hardly distinguish ${told.join(", ")}${more}.`);
  }
  return sentences;
}

function rowSentences({ rows }) {
  if (!rows) return [];
  return rows.columns.map(({ name, unit, values }) => {
    const known = Array.from(values).filter(Number.isFinite);
    const { factor, text } = shownUnit(unit, known);
    const end = (value) => numberText(value * factor, digits);
    if (known.length === 0) return `${symbolText(name)}: no row of ${values.length} has a value.`;
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

// A note of the record as a sentence of plain text; a name that it begins with stays as it is.
export function noteSentence(note) {
  const plain = note.replaceAll("`", "");
  const told = note.startsWith("`") ? `Estimate ${plain}` : sentence(plain);
  return /[.?!]$/.test(told) ? told : `${told}.`;
}

export function outcomeWarning({ outcome }) {
  if (outcome === "converged") return "";
  return outcome === "not_converged"
    ? "This identification did not converge: its estimates are the values at which it stopped, and their intervals mean nothing."
    : "It is not known how this identification ended.";
}
