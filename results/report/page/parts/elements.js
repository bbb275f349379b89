// The page's elements. Texts go in as text, never as markup.

// element("p", {class: "note"}, "text", other element, ...)
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== undefined && value !== null) made.setAttribute(key, String(value));
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

// head: texts; rows: arrays of texts or elements; numbers are aligned right.
export function table(head, rows, { caption, numeric = [] } = {}) {
  const cell = (name, content, column) =>
    element(name, numeric.includes(column) ? { class: "number" } : {}, content ?? "");
  return element(
    "div",
    { class: "scroll", tabindex: 0, role: "group", "aria-label": caption ?? "table" },
    element(
      "table",
      {},
      caption ? element("caption", {}, caption) : null,
      element(
        "thead",
        {},
        element(
          "tr",
          {},
          head.map((text, c) => cell(text === "" ? "td" : "th", text, c)), // a heading has words
        ),
      ),
      element(
        "tbody",
        {},
        rows.map((row) =>
          element(
            "tr",
            {},
            row.map((content, c) => cell("td", content, c)),
          ),
        ),
      ),
    ),
  );
}

export function section(title, ...children) {
  return element("section", { class: "part" }, element("h2", {}, title), ...children);
}
