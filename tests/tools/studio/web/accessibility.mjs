// Checks that run inside the page; each returns what is wrong, in words.

/** Texts whose contrast to their background is below 4.5 (3 for large ones). WCAG 2.2, 1.4.3. */
export function contrast_faults() {
  const parse = (text) => {
    const numbers = (text.match(/[\d.]+(e-?\d+)?/g) ?? []).map(Number);
    const scale = text.startsWith("color(srgb") ? 255 : 1;
    return { rgb: numbers.slice(0, 3).map((value) => value * scale), alpha: numbers[3] ?? 1 };
  };
  const over = (top, bottom) => top.rgb.map((value, i) => value * top.alpha + bottom[i] * (1 - top.alpha));
  const luminance = (rgb) => {
    const [r, g, b] = rgb.map((value) => { const c = value / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const background = (element) => {
    const layers = [];
    for (let at = element; at; at = at.parentElement) {
      layers.push(parse(getComputedStyle(at).backgroundColor));
      const outline = at.classList?.contains("block") ? at.querySelector("svg.outline") : null;
      if (outline) layers.push(parse(getComputedStyle(outline).fill));
    }
    return layers.reverse().reduce((below, layer) => over(layer, below), [255, 255, 255]);
  };
  const faults = [];
  for (const element of document.querySelectorAll("body *")) {
    const has_text = [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.textContent.trim());
    const box = element.getBoundingClientRect(), style = getComputedStyle(element);
    if (!has_text || box.width < 2 || box.height < 2 || style.visibility === "hidden" || style.opacity === "0" || element.closest("svg, .hidden, :disabled, .uplot, option")) continue;
    const behind = background(element), front = over(parse(style.color), behind);
    const [high, low] = [luminance(front), luminance(behind)].sort((a, b) => b - a);
    const ratio = (high + 0.05) / (low + 0.05), size = parseFloat(style.fontSize);
    const needed = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700) ? 3 : 4.5;
    if (ratio < needed) faults.push(`${ratio.toFixed(2)} for "${element.textContent.trim().slice(0, 40)}" (${element.className})`);
  }
  return faults;
}

/** Controls without a name that a screen reader could say. */
export function unnamed() {
  const name = (element) => {
    const labels = (element.getAttribute("aria-labelledby") ?? "").split(" ").map((id) => document.getElementById(id)?.textContent ?? "").join("");
    const own = element.labels ? [...element.labels].map((label) => label.textContent).join("") : "";
    return (element.getAttribute("aria-label") || labels || own || (element.matches("input, select") ? "" : element.textContent) || element.title || "").trim();
  };
  const controls = [...document.querySelectorAll("button, input, select, textarea, a[href], [role=button], [role=slider], [role=separator], [role=tab], [tabindex='0']")];
  return controls.filter((element) => element.getBoundingClientRect().width && !name(element)).map((element) => element.outerHTML.slice(0, 120));
}
