// Sizes of texts in block diagrams. They are estimated with the widths of DejaVu Sans, a wide font: what fits with it
// fits with every usual font, and a picture has the same layout in a page, in a browser and without one.

/** Sizes in px. Nothing is smaller than 11 px at full size, so that a picture may shrink a little. */
export const FONT = { name: 12, type: 11, port: 11, unit: 11, face: 12, sign: 12 };

/** Advance widths of the characters from the blank to ~, in thousandths of the font size. */
const WIDTHS = [318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636, 636, 636, 636, 636,
  636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632, 575, 775, 752, 295, 295, 656, 557, 863, 748, 787,
  603, 787, 695, 635, 611, 732, 684, 989, 685, 611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352, 635, 634,
  278, 278, 579, 278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838];
const OTHER = 760, WIDE = 1000, BOLD = 1.12;

/** Text for SVG, between tags or within a quoted attribute. */
export const escaped = (text) => String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);

/** The name of a block without the subdiagrams around it. */
export const lastName = (path) => path.slice(path.lastIndexOf(".") + 1);

/** Width of a line of text in px. */
export function textWidth(text, size, bold = false) {
  let sum = 0;
  for (const character of text) {
    const code = character.codePointAt(0);
    sum += WIDTHS[code - 32] ?? (code > 0x2e80 ? WIDE : OTHER);
  }
  return sum / 1000 * size * (bold ? BOLD : 1);
}

/** The text, or its start and an ellipsis if it is wider than `width`. */
export function fitted(text, size, width, bold = false) {
  if (textWidth(text, size, bold) <= width) return text;
  const characters = [...text];
  while (characters.length > 1 && textWidth(characters.join("") + "…", size, bold) > width) characters.pop();
  return characters.join("") + "…";
}
