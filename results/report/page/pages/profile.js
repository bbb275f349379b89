// A structure over its height: peaks and strokes at the points of the map, and the mode shapes.
import { driftProfile, modeShapes, peakProfile } from "../figures/profile_figures.js";
import { element, section, table } from "../parts/elements.js";
import { figureCard } from "../parts/figure_card.js";
import { profileOf, worstAlong } from "../profile.js";
import { numberText, unitText } from "../units.js";

// The figures that follow points of the map; [] without a profile.
export function profileFigures(record, pointsOf) {
  const profile = profileOf(record);
  if (!profile) return [];
  return [peakProfile, driftProfile].map((make) => make(record.map, profile, pointsOf)).filter(Boolean);
}

function modesOf(record) {
  const group = record.groups.get("modes"),
    profile = profileOf(record);
  return group && profile ? { group, profile } : null;
}

function modeTable(group) {
  const [frequency, damping] = [group.column("mode_frequency"), group.values("mode_damping")];
  const isTimed = unitText(frequency.unit) !== ""; // not dimensionless
  const rows = Array.from(frequency.values, (omega, k) => [
    k + 1,
    numberText(omega),
    ...(isTimed
      ? [numberText(omega / (2 * Math.PI)), omega > 0 ? numberText((2 * Math.PI) / omega) : ""]
      : []),
    omega > 0 ? numberText(damping[k]) : "free",
  ]);
  const head = isTimed
    ? ["mode", "frequency (rad/s)", "(Hz)", "period (s)", "damping ratio"]
    : ["mode", "frequency", "damping ratio"];
  return table(head, rows, { numeric: head.map((_, c) => c) });
}

// null if the result has no modes, or no profile.
export function modeSection(record) {
  const modes = modesOf(record);
  if (!modes) return null;
  const shown = figureCard(modeShapes(modes.group, modes.profile), record);
  const numbers = element(
    "details",
    {},
    element("summary", {}, "The modes in numbers"),
    modeTable(modes.group),
  );
  return section("Mode shapes", shown.card, numbers);
}

// For papers: at the point of the largest peak along x, for some points along y.
export function allProfileFigures(record, state, points) {
  const profile = profileOf(record),
    modes = modesOf(record);
  if (!profile) return [];
  const worst = points.map((index) => worstAlong(record.map, profile, index, state.x));
  return [...profileFigures(record, () => worst), ...(modes ? [modeShapes(modes.group, modes.profile)] : [])];
}
