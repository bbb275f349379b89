// What a motion means, in sentences of numbers.
import { dampingRatio, interpolated, samplingOf } from "./motion.js";
import { numberText, quantityText, words } from "./units.js";

const digits = 4;
const percentText = (share) => `${numberText(100 * share, 3)} %`;

function restSentence({ kind, stopTime, duration }) {
  if (kind !== "decay") return [];
  return [
    Number.isFinite(stopTime)
      ? `From ${quantityText(stopTime, "s", digits)} on nothing moves.`
      : `Within ${quantityText(duration, "s", digits)} it does not come to rest.`,
  ];
}

function decayOf({ name, unit, turningPoints, decrements, rest }) {
  const sentences = [];
  if (turningPoints.length > 0)
    sentences.push(
      `mass ${words(name)} turns ${turningPoints.length} times, first at ` +
        `${quantityText(turningPoints[0], unit, digits)}, last at ${quantityText(turningPoints.at(-1), unit, digits)}.`,
    );
  const first = decrements[0],
    last = decrements.at(-1);
  if (decrements.length > 0)
    sentences.push(
      `Its logarithmic decrement is ${numberText(first, digits)} in the first cycle (as of ` +
        `${percentText(dampingRatio(first))} viscous ` +
        `damping)${decrements.length > 1 ? ` and ${numberText(last, digits)} in the last` : ""}.`,
    );
  if (Number.isFinite(rest)) sentences.push(`It comes to lie at ${quantityText(rest, unit, digits)}.`);
  return sentences;
}

function peakOf({ name, unit, peak, peakTime }, { time, frequency }) {
  if (!Number.isFinite(peak)) return [];
  const there = frequency
    ? `, where the excitation has ` +
      `${quantityText(interpolated(time.values, frequency.values, peakTime), frequency.unit, digits)}`
    : "";
  return [
    `The largest displacement of mass ${words(name)} is ${quantityText(peak, unit, digits)}, at ` +
      `${quantityText(peakTime, "s", digits)}${there}.`,
  ];
}

function stopSentences({ stops }) {
  return stops.map(({ name, from, to }) => {
    const total = from.reduce((sum, start, i) => sum + to[i] - start, 0);
    return (
      `contact ${words(name)} sticks ${from.length === 1 ? "once" : `${from.length} times`}, ` +
      `${quantityText(total, "s", digits)} in all.`
    );
  });
}

function errorSentence({ discretisationError, frequency, masses }) {
  if (!frequency) return [];
  const { values, unit } = frequency;
  const run = values[0] < values.at(-1) ? "up" : "down";
  return [
    `The excitation runs ${run} from ${quantityText(values[0], unit, digits)} to ` +
      `${quantityText(values.at(-1), unit, digits)}.`,
    ...(Number.isFinite(discretisationError)
      ? [
          `The stairs of frequency that this is computed with change no sample by more than about ` +
            `${quantityText(discretisationError, masses[0]?.unit ?? "m", 2)}.`,
        ]
      : []),
  ];
}

function energySentences({ energies, group }) {
  const total = energies.reduce((sum, { energy }) => sum + energy, 0);
  if (!(total > 0)) return [];
  const shares = [...energies]
    .sort((a, b) => b.share - a.share)
    .map(({ name, share }) => `${percentText(share)} in ${words(name)}`);
  const balance = group.number("energy_balance");
  return [
    `Of ${quantityText(total, "J", digits)} dissipated, ` + `${shares.join(", ")}.`,
    ...(Number.isFinite(balance) ? [`The energy balance closes to ${numberText(balance, 2)}.`] : []),
  ];
}

// Why the history is drawn as dots, and how to see the motion; "" where its samples are dense enough.
export function sparseText(motion) {
  const { step, period, perPeriod, sparse, enough } = samplingOf(motion);
  if (!sparse) return "";
  const few = Number.isFinite(period)
    ? `${numberText(perPeriod, 3)} to a period of ${quantityText(period, "s", digits)}`
    : "and the largest displacement lies between them";
  const more = Number.isFinite(enough) ? `samples = ${enough} or more` : "more samples";
  return (
    `The samples stand ${quantityText(step, "s", digits)} apart, ${few}: lines that join them would show another ` +
    `motion, so they are drawn as dots, without cycles and phase portraits. ${more} in [${motion.kind}] of the ` +
    `study would show the motion.`
  );
}

// Paragraphs of sentences: [[sentence, ...], ...].
export function whatItMeans(motion) {
  return [
    [
      ...errorSentence(motion),
      ...motion.masses.flatMap((mass) => [...decayOf(mass), ...peakOf(mass, motion)]),
      ...restSentence(motion),
    ],
    stopSentences(motion),
    energySentences(motion),
  ]
    .filter((paragraph) => paragraph.length > 0)
    .map((paragraph) => paragraph.map((text) => text.charAt(0).toUpperCase() + text.slice(1)));
}
