// Several figures on the page: side by side where there is room, or each over the whole width.
import { element } from "./elements.js";
import { figureCard } from "./figure_card.js";

// Returns no element for no figures.
export function figureCards(figures, record, width = "") {
  const cards = figures.map((figure) => figureCard(figure, record).card);
  if (cards.length === 0) return [];
  return width === "wide" || cards.length === 1 ? cards : [element("div", { class: "cards" }, ...cards)];
}
