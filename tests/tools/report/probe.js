// Added to a page by browser_test.cpp. It operates the scopes like a reader and stores the results in the title.
addEventListener("load", async () => {
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  const settled = async () => { await new Promise((done) => setTimeout(done, 50)); await frame(); await frame(); };  // scopes draw in frames
  const figures = [...document.querySelectorAll("figure.plot")];
  const mouse = (target, type, x, y) => {
    const box = target.getBoundingClientRect();
    target.dispatchEvent(new MouseEvent(type, { bubbles: true, button: 0, movementX: 1, clientX: box.left + x * box.width, clientY: box.top + y * box.height }));
  };
  const overlay = (k) => figures[k].querySelector(".u-over");
  const zoomed = () => figures.map((figure) => +!figure.querySelector(".reset").hidden).join("");
  const readings = (k) => [".abscissa", "button output"].flatMap((kind) => [...figures[k].querySelectorAll(kind)]).map((output) => output.textContent).join("|");
  const seen = { errors, canvases: document.querySelectorAll("canvas").length };
  const drawn = (canvas) => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((byte) => byte > 0);
  seen.drawn = [...document.querySelectorAll("canvas")].filter(drawn).length;

  mouse(overlay(0), "mouseenter", 0.5, 0.5);
  mouse(overlay(0), "mousemove", 0.5, 0.5);
  await settled();
  seen.read = [readings(0), readings(2)];

  // What is drawn late above a plot moves it under the mouse.
  document.body.prepend(Object.assign(document.createElement("div"), { style: "height: 200px" }));
  await settled();
  mouse(overlay(0), "mousedown", 0.25, 0.5);
  mouse(overlay(0), "mousemove", 0.5, 0.5);
  mouse(overlay(0), "mouseup", 0.5, 0.5);
  await settled();
  seen.zoomed = zoomed();
  mouse(overlay(1), "mouseenter", 0, 0.5);
  mouse(overlay(1), "mousemove", 0.002, 0.5);
  await settled();
  seen.left = readings(1).split("|")[0];

  overlay(2).dispatchEvent(new MouseEvent("dblclick", { bubbles: true }));
  await settled();
  seen.whole = zoomed();

  const button = figures[0].querySelector("button");
  button.click();
  await settled();
  seen.pressed = button.getAttribute("aria-pressed");
  document.title = JSON.stringify(seen);
});
