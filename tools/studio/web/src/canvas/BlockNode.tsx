// One block, input or output of the diagram on the canvas.
import { memo } from "react";
import { Handle, Position, type NodeProps, type Node } from "@xyflow/react";
import { prettyUnit } from "../numbers";
import { port_names_width, spaced } from "./symbols";
import { label_above, type GraphNode, type Place } from "./graph";

export interface BlockData extends Record<string, unknown> {
  node: GraphNode;
  highlighted: boolean;
  tint: { share: number; text: string } | null;
  severity: "error" | "warning" | "";
}
export type BlockFlowNode = Node<BlockData, "block">;

const SIDES = { WEST: Position.Left, EAST: Position.Right, SOUTH: Position.Bottom } as const;

function Outline({ node }: { node: GraphNode }) {
  const { width, height, shape } = node.look;
  const inset = 0.75;  // px: half of the line
  if (shape === "triangle")
    return <path d={`M${inset} ${inset}L${width - inset} ${height / 2}L${inset} ${height - inset}Z`} />;
  if (shape === "circle")
    return <circle cx={width / 2} cy={height / 2} r={width / 2 - inset} />;
  const radius = shape === "terminal" ? height / 2 : 5;
  return (
    <>
      <rect x={inset} y={inset} width={width - 2 * inset} height={height - 2 * inset} rx={radius} />
      {shape === "subdiagram" && <rect className="inner" x={4} y={4} width={width - 8} height={height - 8} rx={3} />}
    </>
  );
}

const placeTitle = (place: Place): string =>
  [place.port + (place.unit ? ` [${prettyUnit(place.unit)}]` : ""), place.sentence].filter(Boolean).join(": ");

function Ports({ node }: { node: GraphNode }) {
  return (
    <>
      {node.places.map((place) => {
        const is_source = place.id.startsWith("out:");
        return (
          <Handle key={place.id} id={place.id} type={is_source ? "source" : "target"} position={SIDES[place.side]}
            className={place.connected ? "port connected" : "port"} style={{ left: place.x, top: place.y }} title={placeTitle(place)} />
        );
      })}
      {node.look.named_ports && node.places.map((place) => (
        <span key={place.id} className={`port-name ${place.side === "EAST" ? "right" : "left"}`} style={{ top: place.y }} aria-hidden="true">{place.port}</span>
      ))}
      {node.block?.type === "Sum" && node.places.filter((place) => place.sign).map((place) => (
        <span key={place.id} className={`sign ${place.side === "SOUTH" ? "below" : ""}`} aria-hidden="true"
          style={place.side === "SOUTH" ? { left: place.x, top: place.y } : { left: place.x, top: place.y }}>{place.sign === "-" ? "−" : place.sign}</span>
      ))}
    </>
  );
}

function description(node: GraphNode): string {
  const block = node.block;
  if (!block) return `${node.name}, ${node.kind} of the diagram${node.unit ? `, ${prettyUnit(node.unit)}` : ""}`;
  return [block.name, block.subdiagram ? "subdiagram" : spaced(block.type), block.hardware && "hardware", block.description || block.title].filter(Boolean).join(", ");
}

/** The symbol stands in the middle of what the names of the ports leave free. */
function between_names(node: GraphNode): { paddingLeft?: number; paddingRight?: number } {
  if (!node.look.named_ports) return {};
  const longest = (side: string) => port_names_width(node.places.filter((place) => place.side === side).map((place) => place.port));
  return { paddingLeft: longest("WEST"), paddingRight: longest("EAST") };
}

export const BlockNode = memo(function BlockNode({ data, selected }: NodeProps<BlockFlowNode>) {
  const { node, highlighted, tint, severity } = data, block = node.block;
  const { width, height, shape } = node.look;
  const rate = block && block.rate > 0 ? ` rate-${((block.rate - 1) % 4) + 1}` : "";
  const classes = ["block", shape, `room-${block?.subdiagram ? "subdiagram" : block?.room ?? node.kind}`, selected && "selected", highlighted && "highlighted", severity, tint && "tinted"];
  return (
    <div className={classes.filter(Boolean).join(" ") + rate} style={{ width, height }} title={description(node)} data-block={node.name} data-type={block?.type ?? node.kind}>
      <svg className="outline" width={width} height={height} aria-hidden="true"><Outline node={node} /></svg>
      {tint && <svg className="outline tint" width={width} height={height} aria-hidden="true" style={{ opacity: 0.08 + 0.4 * Math.min(1, tint.share) }}><Outline node={node} /></svg>}
      <div className="content" style={between_names(node)}>{shape === "terminal" ? <span className="symbol">{node.name}</span> : node.look.content}</div>
      <Ports node={node} />
      {block && <div className={label_above(node) ? "block-name above" : "block-name"}>{block.name}{block.variant && <span className="variant"> {block.variant}</span>}</div>}
      {tint && <div className="badge share" title={tint.text}>{Math.round(100 * tint.share)} %</div>}
      {severity && <div className={`badge ${severity}`} title="See the list of problems">!</div>}
      {block?.hardware && <div className="badge hardware" title="A device: deployed, this block moves it. The studio opens no device.">⏚</div>}
      {rate && <div className="rate-mark" title={`sampled every ${block!.sample_time} s`} />}
    </div>
  );
});
