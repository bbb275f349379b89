// The plain words at the head of a page.
import { element, section } from "./elements.js";

// paragraphs: [[sentence, ...], ...]; more: further elements.
export function meaningSection(paragraphs, ...more) {
  const words = paragraphs.map((sentences) => element("p", { class: "words" }, sentences.join(" ")));
  return section("What this means", ...words, ...more);
}
