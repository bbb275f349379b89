// The response over the band: as the study states it, tuned, of the best constant and by the rule.
import { coordinateLabel, symbolText } from "../axes.js";
import { designNames, responseWords, steepestPieces } from "../tuning.js";
import { numberText, words } from "../units.js";
import { lineFigure } from "./line_figure.js";
import { lineColours, lineDashes } from "./frame.js";

const colours = {
  before: lineColours[7],
  after: lineColours[0],
  constant: lineColours[1],
  rule: lineColours[2],
};
const drawnFirst = ["before", "constant", "after", "rule"];

function responseLine({ band, scenarios }, { design, scenario, values }) {
  const dash =
    scenarios.length > 1 ? lineDashes[scenarios.indexOf(scenario)] : design === "rule" ? "5 4" : "";
  const text = `${designNames[design]}${scenario ? `, ${words(scenario)}` : ""}`;
  return {
    name: `response_${design}${scenario ? `_${scenario}` : ""}`,
    text,
    x: band.values,
    y: values,
    stroke: colours[design],
    width: design === "after" ? 2.2 : 1.6,
    dash,
  };
}

// "active peak", "active end of the band" or both, by where they lie.
function placeWords(prefix, chosen) {
  const ends = chosen.filter(({ atEnd }) => atEnd).length;
  const peak = ends === chosen.length && ends > 0 ? "" : "peak";
  return [prefix, [peak, ends ? "end of the band" : ""].filter(Boolean).join(" or ")]
    .filter(Boolean)
    .join(" ");
}

function peakPoints({ peaks, isWorst, converged }) {
  const of = (chosen) => ({ x: chosen.map(({ at }) => at), y: chosen.map(({ value }) => value) });
  const points = (name, prefix, symbol, chosen) => ({
    name,
    text: placeWords(prefix, chosen),
    symbol,
    stroke: colours.after,
    r: 4.5,
    ...of(chosen),
  });
  return [
    points(
      "active_peak",
      "active",
      "full",
      peaks.filter(({ active }) => active),
    ),
    points(
      "other_peak",
      isWorst && converged ? "other" : "",
      "open",
      peaks.filter(({ active }) => !active),
    ),
  ].filter(({ x }) => x.length > 0);
}

function peaksText({ peaks, isWorst, converged }) {
  if (peaks.length === 0) return "";
  return isWorst && converged
    ? "Peaks are solved, not sampled; those that hold the optimum are filled."
    : "Peaks are solved, not sampled.";
}

function weightText({ weight }) {
  return weight ? " The response is multiplied by the study's weight, which has its own figure." : "";
}

export function responseFigure(tuning) {
  const { band, responses, root, isWorst, worst } = tuning;
  const lines = [...responses]
    .sort((a, b) => drawnFirst.indexOf(a.design) - drawnFirst.indexOf(b.design))
    .map((response) => responseLine(tuning, response));
  const worstPeak = isWorst && Number.isFinite(worst.after);
  return lineFigure({
    name: "tuned_response",
    title: `Response over the band: ${responseWords(tuning)}`,
    caption: `${peaksText(tuning)}${weightText(tuning)}`.trim(),
    ratio: 0.5,
    x: { ...axisOf(band), tight: true },
    y: {
      label: responseWords(tuning),
      unit: root,
      zero: true,
    },
    lines,
    points: peakPoints(tuning),
    levels: worstPeak ? [{ text: "worst, tuned", y: worst.after, stroke: colours.after, dash: "10 4" }] : [],
  });
}

function axisOf({ name, unit, long_name }) {
  return {
    label: coordinateLabel({
      name,
      unit: "1",
      long_name: long_name === "band of the tuning" ? "" : long_name,
    }),
    name,
    unit,
  };
}

export function weightFigure({ band, weight }) {
  return lineFigure({
    name: "weight",
    title: "Weight over the band",
    caption: "The factor on the response that is tuned.",
    x: { ...axisOf(band), tight: true },
    y: { label: "weight", unit: "1", zero: true },
    lines: [{ name: "weight", x: band.values, y: weight, stroke: colours.after }],
  });
}

function knotPoints({ knots, values, lower, upper }, { lower: low, upper: high }) {
  const bound = new Set([...low, ...high]);
  const of = (name, text, symbol, chosen) => ({
    name,
    text,
    symbol,
    stroke: colours.after,
    x: chosen.map((i) => knots[i]),
    y: chosen.map((i) => values[i]),
  });
  const all = Array.from(knots, (_, i) => i);
  return [
    of(
      "knot_free",
      "knot between the bounds",
      "open",
      all.filter((i) => !bound.has(i)),
    ),
    of(
      "knot_on_bound",
      "knot on a bound",
      "full",
      all.filter((i) => bound.has(i)),
    ),
  ].filter(({ x }) => x.length > 0);
}

function steepText(parameter) {
  const steep = steepestPieces(parameter);
  if (Number.isNaN(steep)) return "";
  const most = `${numberText(parameter.maxSlope)} up or down`;
  return `; as steep as allowed (${most}) on ${steep} of ${parameter.knots.length - 1} pieces`;
}

export function scheduleFigure({ band }, parameter, atBounds) {
  const { name, unit, schedule, rule, constant, before, lower, upper, knots, values } = parameter;
  const over = schedule ? band.values : knots,
    y = schedule ?? values;
  return lineFigure({
    name: `schedule_${name}`,
    title: `Schedule of ${symbolText(name)}`,
    caption: `Linear between its knots${steepText(parameter)}.`,
    x: { ...axisOf(band), tight: true },
    y: { label: symbolText(name), unit },
    lines: [
      { name, text: "schedule", x: over, y, stroke: colours.after, width: 2.2 },
      ...(rule
        ? [
            {
              name: `${name}_rule`,
              text: "rule, within the bounds",
              x: band.values,
              y: rule,
              stroke: colours.rule,
              dash: "5 4",
            },
          ]
        : []),
    ],
    points: knotPoints(parameter, atBounds),
    levels: [
      ...level("bounds", lower, "currentColor", "1 3"),
      ...level("", upper, "currentColor", "1 3"),
      ...level("best constant", constant, colours.constant, "7 3"),
      ...level("before", before, colours.before, "3 3"),
    ],
  });
}

const level = (text, at, stroke, dash) => (Number.isFinite(at) ? [{ text, y: at, stroke, dash }] : []);

// A column beside the schedule (a CVT's ratio), with its range if it has one.
export function columnFigure({ band }, { name, unit, values, range, lower, upper }) {
  const flagged = (word, text, symbol) => {
    const code = range.flags.find(([, meaning]) => meaning === word)?.[0];
    const rows = Array.from(values, (_, i) => i).filter((i) => range.values[i] === code);
    return {
      name: `${name}_${word}`,
      text,
      symbol,
      stroke: colours.constant,
      r: 2.6,
      x: rows.map((i) => band.values[i]),
      y: rows.map((i) => values[i]),
    };
  };
  const outside = [
    flagged("below", "below its range", "open"),
    flagged("above", "above its range", "full"),
  ].filter(({ x }) => x.length > 0);
  const ends = [
    ...level("lower end of its range", lower, "currentColor", "1 3"),
    ...level("upper end of its range", upper, "currentColor", "5 3"),
  ];
  return lineFigure({
    name: `column_${name}`,
    title: `${words(name)} over the band`,
    caption:
      ends.length === 0
        ? ""
        : outside.length
          ? "Points outside its range are marked."
          : "Within its range over the whole band.",
    x: { ...axisOf(band), tight: true },
    y: { label: words(name), unit },
    lines: [{ name, text: ends.length ? words(name) : "", x: band.values, y: values, stroke: colours.after }],
    points: outside,
    levels: ends,
  });
}
