// The foot of the page: what made the result.
import { element, section, table } from "./elements.js";

const long = new Set(["study", "flags", "libraries", "failed_points"]);

export function provenanceSection(record) {
  const { provenance } = record;
  const rows = Object.entries(provenance)
    .filter(([name]) => !long.has(name))
    .map(([name, text]) => [name.replaceAll("_", " "), text]);
  rows.push(["history", record.history]);
  for (const name of ["libraries", "flags"]) if (provenance[name]) rows.push([name, provenance[name]]);
  return section(
    "Provenance",
    table(
      ["", ""],
      rows.filter(([, text]) => text !== ""),
    ),
    element(
      "details",
      { class: "study" },
      element("summary", {}, `The study, ${provenance.study_file ?? ""}`),
      element("pre", { tabindex: 0 }, provenance.study ?? ""),
    ),
  );
}
