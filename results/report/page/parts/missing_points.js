// Which points of a map have no number, and why.
import { meaningOf } from "../record.js";
import { element, section } from "./elements.js";

// Notes on the missing points, with their causes; [] if none are missing.
export function missingPoints(record) {
  const { map, provenance } = record;
  const notes = [];
  const add = (text) => notes.push(element("p", { class: "warning" }, text));
  if (provenance.missing_tiles)
    add(
      `This is part of a map: ${provenance.missing_tiles} of its tiles were not computed. Their points are grey. To complete the file, use frahm run, or frahm merge when all tasks are done.`,
    );
  const status = map.variable("status");
  const codes = new Map();
  for (const value of status?.values ?? []) codes.set(value, (codes.get(value) ?? 0) + 1);
  const counts = new Map(
    [...codes].map(([code, count]) => [meaningOf(status, code) || "not_computed", count]),
  );
  const told = {
    failed: "failed (no value; the reasons are below)",
    unbounded: "have no bounded response (an undamped mode driven at resonance)",
    not_periodic:
      "have no periodic response that was found (no value; the reasons below say what was searched)",
    not_computed: "were not computed",
  };
  for (const [word, text] of Object.entries(told))
    if (counts.get(word)) add(`${counts.get(word)} of ${map.points} points ${text}.`);
  const note = (text) => notes.push(element("p", { class: "note" }, text));
  if (counts.get("grazing"))
    note(
      `${counts.get("grazing")} of ${map.points} points only just touch another regime (grazing): their responses are right, but have no derivative.`,
    );
  if (counts.get("several"))
    note(
      `${counts.get("several")} of ${map.points} points have several stable responses, one of which is shown.${searched(provenance)}`,
    );
  const aboveZero = (name) =>
    (map.variable(name)?.values ?? []).reduce((count, value) => count + (value > 0 ? 1 : 0), 0);
  if (aboveZero("unsettled"))
    note(
      `At ${aboveZero("unsettled")} of ${map.points} points some starts of the search reached no stable response: others may exist.${searched(provenance)}`,
    );
  if (aboveZero("continuum"))
    note(
      `${aboveZero("continuum")} of ${map.points} points show one of a continuum of responses, because sliders of jenkins or iwan elements never slip there and may have other offsets: the motion shown is the one with z(T/2) = -z(0), otherwise the one of least energy. The error bound is of the one shown.`,
    );
  return notes;
}

// What was searched, as a sentence.
function searched({ orbits_searched: text }) {
  return text ? ` Searched ${text}.` : "";
}

const failuresAtOnce = 12;

// The first reasons, and the others behind a click.
function failureList(failed) {
  const lines = failed.split("\n");
  const rest = lines.slice(failuresAtOnce);
  const more = element(
    "details",
    {},
    element("summary", {}, `${rest.length} more`),
    element("pre", { tabindex: 0 }, rest.join("\n")),
  );
  return element(
    "div",
    {},
    element("pre", { tabindex: 0 }, lines.slice(0, failuresAtOnce).join("\n")),
    rest.length ? more : null,
  );
}

// The section of reasons, or null.
export function failedPoints({ provenance }) {
  if (!provenance.failed_points) return null;
  const title = provenance.orbits_searched ? "Points without a response" : "Points that failed";
  return section(title, failureList(provenance.failed_points));
}
