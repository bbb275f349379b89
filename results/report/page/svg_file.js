// The SVG file of a figure, complete in itself.

// Adds title and description, and black ink. about: a line on where it comes from. Returns the element.
export function svgFile(svg, title, about) {
  const described = (name, text) => {
    const made = svg.ownerDocument.createElementNS("http://www.w3.org/2000/svg", name);
    made.appendChild(svg.ownerDocument.createTextNode(text));
    return made;
  };
  svg.insertBefore(described("desc", about), svg.firstChild);
  svg.insertBefore(described("title", title), svg.firstChild);
  svg.setAttribute("color", "black");
  return svg;
}
