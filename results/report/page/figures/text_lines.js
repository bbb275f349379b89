// Estimates the width of texts, and breaks them into lines.

export const fontSize = 12;
export const digitWidth = 0.64 * fontSize; // of the widest common font
const characterWidth = 0.56 * fontSize; // of a sans-serif font, on average

export function textWidth(text) {
  return text.length * characterWidth;
}

// A text in lines that fit the width: broken at blanks, and within words too long for a line.
export function wrapped(text, width) {
  const most = Math.max(4, Math.floor(width / characterWidth));
  const lines = [""];
  for (let word of text.split(" ")) {
    const joined = lines.at(-1) === "" ? word : `${lines.at(-1)} ${word}`;
    if (joined.length <= most) {
      lines[lines.length - 1] = joined;
      continue;
    }
    if (lines.at(-1) !== "") lines.push("");
    for (; word.length > most; word = word.slice(most)) lines.splice(-1, 0, word.slice(0, most));
    lines[lines.length - 1] = word;
  }
  return lines;
}
