// The head of the page: title, and what kind of result this is.
import { element } from "./elements.js";

export function heading(record) {
  const made = record.provenance.finished ?? "";
  return element(
    "header",
    { class: "top" },
    element("h1", {}, record.title || record.file),
    element("p", { class: "sub" }, [record.file, record.source, made].filter(Boolean).join(" \u00b7 ")),
  );
}
