// The SVG file of a figure, complete in itself.

const width = 720,
  ratio = 0.6; // height over width, unless the figure states it

// The origin of a figure in one line.
function about(record) {
  const fingerprint = record.provenance.fingerprint_physics ?? "";
  return `${record.title}; ${record.file}; ${record.source}; fingerprint ${fingerprint}`;
}

// The figure drawn for a paper: with title and description, in black ink. host: {document, image(width, height,
// rgba): data URL}. Returns the element.
export function svgFile(figure, record, host) {
  const height = Math.round(width * (figure.ratio ?? ratio));
  const svg = figure.draw({ width, height, ...host, interactive: false });
  const described = (name, text) => {
    const made = svg.ownerDocument.createElementNS("http://www.w3.org/2000/svg", name);
    made.appendChild(svg.ownerDocument.createTextNode(text));
    return made;
  };
  const title = [figure.title, figure.caption].filter(Boolean).join("; ");
  svg.insertBefore(described("desc", about(record)), svg.firstChild);
  svg.insertBefore(described("title", title), svg.firstChild);
  svg.setAttribute("color", "black");
  return svg;
}
