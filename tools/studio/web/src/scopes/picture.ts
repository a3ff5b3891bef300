// Saves what the scopes show as one PNG picture.

export function save_picture(area: HTMLElement, name: string): void {
  const plots = [...area.querySelectorAll<HTMLElement>(".plot")].map((plot) => ({
    canvas: plot.querySelector("canvas"), title: [...plot.querySelectorAll(".legend li span")].map((label) => label.textContent).join("   "),
  })).filter((plot) => plot.canvas);
  if (!plots.length) return;
  const scale = devicePixelRatio, title_height = 22 * scale;
  const result = document.createElement("canvas");
  result.width = Math.max(...plots.map((plot) => plot.canvas!.width));
  result.height = plots.reduce((sum, plot) => sum + plot.canvas!.height + title_height, 0);
  const pen = result.getContext("2d")!;
  const style = getComputedStyle(document.documentElement);
  pen.fillStyle = style.getPropertyValue("--paper");
  pen.fillRect(0, 0, result.width, result.height);
  let top = 0;
  for (const { canvas, title } of plots) {
    pen.fillStyle = style.getPropertyValue("--ink");
    pen.font = `${12 * scale}px ${getComputedStyle(document.body).fontFamily}`;
    pen.fillText(title, 60 * scale, top + 15 * scale);
    pen.drawImage(canvas!, 0, top + title_height);
    top += canvas!.height + title_height;
  }
  result.toBlob((blob) => {
    if (!blob) return;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}
