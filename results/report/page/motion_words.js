// The results of a motion as sentences.
import {
  dampingRatio,
  decrementsEndEarly,
  interpolated,
  isHeldSinceTurning,
  isOneMode,
  isRounding,
  isRoundingOf,
  isStill,
  samplingOf,
  swingsAboutZero,
} from "./motion.js";
import { numberText, quantityText, sentence, shareText, words } from "./units.js";

const digits = 4;

// The rest of all masses together, unless the sentences on each mass state it.
function restSentence({ kind, stopTime, duration, masses, units }) {
  if (kind !== "decay" || stopTime === 0) return [];
  if (Number.isNaN(stopTime) && masses.some(({ rest }) => Number.isFinite(rest))) return [];
  return [
    Number.isFinite(stopTime)
      ? `Nothing moves after ${quantityText(stopTime, units.time, digits)}.`
      : `Within ${quantityText(duration, units.time, digits)} it does not come to rest.`,
  ];
}

// "0.51", or "0 (rounding)".
export function decrementText(decrement, places = digits) {
  return isRounding(decrement) ? "0 (rounding)" : numberText(decrement, places);
}

function turningSentence({ name, noun, unit, turningPoints }, { kind }) {
  if (kind !== "decay") return [];
  const count = turningPoints.length;
  if (count === 0) return [`${noun} ${words(name)} does not turn.`];
  const first = quantityText(turningPoints[0], unit, digits);
  if (count === 1) return [`${noun} ${words(name)} turns once, at ${first}.`];
  const last = isRoundingOf(turningPoints.at(-1), turningPoints)
    ? "a displacement below rounding"
    : quantityText(turningPoints.at(-1), unit, digits);
  return [`${noun} ${words(name)} turns ${count} times, first at ${first}, last at ${last}.`];
}

function decrementSentence(mass, motion) {
  const { decrements } = mass,
    count = decrements.length;
  if (count === 0 || !swingsAboutZero(mass, motion)) return [];
  if (decrements.every(isRounding))
    return ["Its logarithmic decrement is 0 apart from rounding: nothing damps it."];
  const first = `${decrementText(decrements[0])} in the first cycle`;
  const ratio =
    isOneMode(motion) && !isRounding(decrements[0])
      ? ` (as with ${shareText(dampingRatio(decrements[0]))} viscous damping)`
      : "";
  const which = decrementsEndEarly(mass)
    ? `the last one above rounding, from turning point ${count} of ${mass.turningPoints.length}`
    : "the last";
  const last = count > 1 ? ` and ${decrementText(decrements.at(-1))} in ${which}` : "";
  return [`Its logarithmic decrement is ${first}${ratio}${last}.`];
}

// The rest position of a mass, or the limit it tends to; zero if it is rounding compared with the motion.
export function restText({ rest, unit, turningPoints }, places = digits) {
  return rest !== 0 && isRoundingOf(rest, turningPoints) ? "0 (rounding)" : quantityText(rest, unit, places);
}

// The state of a mass relative to its rest position at the end of the record: "rests", "held" (others move on), "tends"
// (it never arrives, or nearer than rounding) or "moves" (friction stops it later, or it never arrives).
export function approachOf(mass, motion) {
  if (Number.isFinite(motion.stopTime)) return "rests";
  if (isHeldSinceTurning(mass, motion)) return "held";
  return motion.mayStop && !motion.followed ? "moves" : "tends";
}

// The rest position of a mass, if it has one.
function restOfMass(mass, motion) {
  if (!Number.isFinite(mass.rest)) return [];
  const at = restText(mass),
    timeText = (time) => quantityText(time, motion.units.time, digits);
  switch (approachOf(mass, motion)) {
    case "rests":
      return [`It comes to rest at ${at}.`];
    case "held":
      return [`It reaches its rest position, ${at}, at ${timeText(mass.turningTimes.at(-1))}.`];
    case "tends":
      // Damped by less than critical, it is stopped in the end, nearer to its rest than rounding.
      return [motion.mayStop ? `It tends to ${at}.` : `It tends to ${at} without ever arriving.`];
    default:
      return [`It does not reach its rest position, ${at}, within ${timeText(motion.duration)}.`];
  }
}

function decayOf(mass, motion) {
  if (isStill(mass, motion))
    return [`${mass.noun} ${words(mass.name)} does not move: it rests at ${restText(mass)}.`];
  return [...turningSentence(mass, motion), ...decrementSentence(mass, motion), ...restOfMass(mass, motion)];
}

function peakOf({ name, noun, unit, peak, peakTime }, { time, frequency, units }) {
  if (!Number.isFinite(peak)) return [];
  const there = frequency
    ? `, where the excitation has ` +
      `${quantityText(interpolated(time.values, frequency.values, peakTime), frequency.unit, digits)}`
    : "";
  return [
    `The largest displacement of ${noun} ${words(name)} is ${quantityText(peak, unit, digits)}, at ` +
      `${quantityText(peakTime, units.time, digits)}${there}.`,
  ];
}

function stopSentences({ stops, units }) {
  return stops.map(({ name, from, to }) => {
    const total = from.reduce((sum, start, i) => sum + to[i] - start, 0);
    return (
      `contact ${words(name)} sticks ${from.length === 1 ? "once" : `${from.length} times`}, ` +
      `${quantityText(total, units.time, digits)} in all.`
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
          `Because the frequency is computed in steps, samples are off by at most about ` +
            `${quantityText(discretisationError, masses[0]?.unit ?? "m", 2)}.`,
        ]
      : []),
  ];
}

function energySentences({ energies, group, units }) {
  const total = energies.reduce((sum, { energy }) => sum + energy, 0);
  if (!(total > 0)) return [];
  const shares = [...energies]
    .sort((a, b) => b.share - a.share)
    .map(({ name, share }) => `${shareText(share)} in ${words(name)}`);
  const balance = group.number("energy_balance");
  return [
    `Of the ${quantityText(total, units.energy, digits)} dissipated, ${shares.join(", ")}.`,
    ...(Number.isFinite(balance) ? [`The energy balance closes to ${numberText(balance, 2)}.`] : []),
  ];
}

// Why the history is drawn as dots, and how to see the motion; "" where its samples are dense enough.
export function sparseText(motion) {
  const { step, period, perPeriod, sparse, enough } = samplingOf(motion);
  if (!sparse) return "";
  const timeText = (time) => quantityText(time, motion.units.time, digits);
  const few = Number.isFinite(period)
    ? `${numberText(perPeriod, 3)} per period of ${timeText(period)}`
    : "and the largest displacement lies between them";
  const more = Number.isFinite(enough) ? `With samples = ${enough} or more` : "With more samples";
  return (
    `The samples are ${timeText(step)} apart, ${few}: lines that join them would show a different ` +
    `motion, so they are drawn as dots, without cycles and phase portraits. ${more} in [${motion.kind}] of the ` +
    `study would show it.`
  );
}

// Paragraphs of sentences: [[sentence, ...], ...].
export function whatItMeans(motion) {
  return [
    [
      ...errorSentence(motion),
      ...motion.masses.flatMap((mass) => [...decayOf(mass, motion), ...peakOf(mass, motion)]),
      ...restSentence(motion),
    ],
    stopSentences(motion),
    energySentences(motion),
  ]
    .filter((paragraph) => paragraph.length > 0)
    .map((paragraph) => paragraph.map(sentence));
}
