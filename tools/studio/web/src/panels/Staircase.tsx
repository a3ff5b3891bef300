// The error after each effect, falling to the noise.
import { quantity } from "../numbers";
import type { Step } from "../protocol/types";

const WIDTH = 320, HEIGHT = 132, LEFT = 4, RIGHT = 4, TOP = 22, BOTTOM = 22;  // px

export function Staircase({ steps, floor, unit, running }: { steps: Step[]; floor: number | null; unit: string; running: boolean }) {
  const shown = steps.filter((step) => step.error !== null);
  if (!shown.length) return null;
  const largest = Math.max(...shown.map((step) => step.error!));
  const share = (value: number) => value / largest;
  const y = (value: number) => TOP + (HEIGHT - TOP - BOTTOM) * (1 - Math.max(0, Math.min(1, share(value))));
  const width = (WIDTH - LEFT - RIGHT) / Math.max(shown.length, 3);
  const words = shown.map((step, i) => `${i ? "with " + (step.added.join(" and ") || "nothing") : "as it is"}: ${quantity(step.error, unit, 3)}`).join(", ");
  return (
    <svg className={running ? "staircase running" : "staircase"} viewBox={`0 0 ${WIDTH} ${HEIGHT}`} role="img" aria-label={`Error ${words}${floor !== null ? `, noise ${quantity(floor, unit, 3)}` : ""}`} data-steps={shown.length}>
      {floor !== null && <><rect className="floor"  x={0} width={WIDTH} y={y(floor)} height={HEIGHT - BOTTOM - y(floor)} /><text className="floor-label" x={WIDTH - 4} y={11} textAnchor="end">noise {quantity(floor, unit, 2)}</text></>}
      {shown.map((step, i) => {
        const left = LEFT + i * width, top = y(step.error!), name = step.added.length ? "+ " + step.added.map((entry) => entry.replace(/_/g, " ")).join(", ") : i ? "refined" : "as it is";
        return (
          <g key={i} className={step.optional ? "step optional" : "step"}>
            <rect x={left} y={top} width={width - 4} height={HEIGHT - BOTTOM - top} rx={2} />
            <text className="value" x={left + (width - 4) / 2} y={top - 5} textAnchor="middle">{quantity(step.error, unit, 3)}</text>
            <text className="name" x={left + (width - 4) / 2} y={HEIGHT - 8} textAnchor="middle">{name.length > width / 5.4 ? name.slice(0, Math.floor(width / 5.4) - 1) + "…" : name}<title>{name}</title></text>
          </g>
        );
      })}
      <line className="base" x1={0} x2={WIDTH} y1={HEIGHT - BOTTOM} y2={HEIGHT - BOTTOM} />
    </svg>
  );
}
