// Whether a tuning is a proven optimum, and why not, as sentences.
import { symbolText } from "./axes.js";
import { numberText, quantityText, unitText } from "./units.js";

const roundingGap = 1e-12; // relative

// The gap between the worst peak and the bound that the tuning found; no sentence if there is no gap, as where no
// design meets the limits.
function gapSentences({ isAmplitude, isWorst, band, records, group, texts, converged }) {
  const gap = Math.abs(group.number("certificate_gap")),
    overRecords = records?.length > 0;
  if (!isAmplitude || !(band || overRecords) || Number.isNaN(gap)) return [];
  const near = gap < roundingGap ? "rounding" : `${numberText(gap, 2)} (relative)`;
  const claim = texts?.not_proved ? "Among the responses found" : "Certificate";
  const solved = overRecords
    ? "the motion under every record was solved to its end"
    : "all peaks of the band were solved";
  const result = isWorst ? "worst" : "mean";
  return converged
    ? [`${claim}: ${solved}; the ${result} of them and the bound of the tuning agree to ${near}.`]
    : [`There is no certificate; the ${result} peak and the bound of the tuning differ by ${near}.`];
}

function conditionSentences({ group, converged }) {
  const residual = group.number("kkt_residual");
  if (Number.isNaN(residual)) return [];
  const text = `${numberText(residual, 2)} (relative)`;
  if (converged) return [`The conditions of a local optimum hold to ${text}.`];
  return residual <= group.number("tolerance")
    ? [`The conditions of a local optimum hold to ${text} at the last step, which does not prove an optimum.`]
    : [`The conditions of a local optimum do not hold: KKT residual ${text}.`];
}

// "12 of 20 starts reached this objective to 0.1 %".
function startsText(group) {
  const found = Array.from(group.values("start_objective")),
    best = group.number("objective");
  const alike = found.filter((value) => Math.abs(value - best) <= 1e-3 * Math.abs(best)).length;
  return (
    `${alike} of ${found.length} starts reached this objective to 0.1 %; that no better design lies elsewhere ` +
    `is not proved`
  );
}

// Where several responses may exist: what their search leaves open.
function searchSentences({ texts }) {
  const text = texts?.not_proved ?? "";
  return text ? [`Several responses may exist: ${text}.`] : [];
}

export function certificateSentences(tuning) {
  const { group, converged } = tuning;
  const starts = group.values("start_objective")?.length ?? 1;
  const elsewhere =
    starts > 1
      ? [`${startsText(group)}.`]
      : converged
        ? [
            "Only one start was made: it is not proved that no better design lies elsewhere within the bounds.",
          ]
        : [];
  return [...gapSentences(tuning), ...conditionSentences(tuning), ...elsewhere, ...searchSentences(tuning)];
}

const outcomeWords = {
  not_converged: "This tuning did not converge. What follows is the best design found, not a proven optimum",
  infeasible: "No design was found that meets every limit. What follows breaks one",
  unbounded: "The response has no bound somewhere in the band. What follows is the last design of the tuning",
  failed: "This tuning failed. What follows is its last design",
  stopped: "This tuning was stopped before its end. What follows is the best design so far",
};

// The reason of the record; its value in the band, which is in SI, gets the name and unit of the band's parameter.
export function reasonText({ reason, band }) {
  if (!band || !["1", "rad s-1"].includes(band.unit)) return reason;
  const after = unitText(band.unit);
  return reason.replace(
    / at (\S+) of the band/,
    ` at ${symbolText(band.name)} = $1${after ? ` ${after}` : ""}`,
  );
}

// Why the tuning did not converge, or "". For a trade-off this is about its last limit.
export function outcomeWarning(tuning) {
  const { outcome, converged, group, front } = tuning;
  if (converged) return "";
  const violation = group.number("violation");
  const broken = violation > 0 ? ` (largest violation of a limit: ${numberText(100 * violation, 4)} %)` : "";
  const reason = outcome === "infeasible" ? "" : reasonText(tuning); // which would repeat the outcome
  const told =
    `${outcomeWords[outcome] ?? "It is not known how this tuning ended"}${broken}` +
    `${reason ? `: ${reason}` : ""}.`;
  if (!front) return told;
  const limit = quantityText(group.number("trade_off"), front.column("trade_off").unit, 4);
  return `For the last limit, ${limit}: ${told.charAt(0).toLowerCase()}${told.slice(1)}`;
}
