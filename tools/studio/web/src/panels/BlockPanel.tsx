// One block: its numbers, where its inputs come from, what its outputs show, what its type does.
import { memo, useEffect, useMemo, useRef, useState } from "react";
import { prettyUnit } from "../numbers";
import { edit, enter, open } from "../state/document";
import { toggle_signal } from "../state/run";
import { ask } from "../state/session";
import { useStudio } from "../state/store";
import { signal_name } from "../state/signals";
import type { Block, TypeHelp, View } from "../protocol/types";
import { ChartPanel } from "../chart/ChartPanel";
import { open_chart } from "../state/chart";
import { spaced } from "../canvas/symbols";
import { Field, SliderField } from "./fields";

const help_of = new Map<string, Promise<TypeHelp>>();
function useHelp(type: string): TypeHelp | null {
  const [help, setHelp] = useState<TypeHelp | null>(null);
  useEffect(() => {
    setHelp(null);
    if (!type) return;
    let current = true;
    if (!help_of.has(type)) help_of.set(type, ask<TypeHelp>("type", { type }));
    help_of.get(type)!.then((answer) => { if (current) setHelp(answer); }, () => help_of.delete(type));
    return () => { current = false; };
  }, [type]);
  return help;
}

/** All that a wire may come from; the same list as long as nothing of it changes. */
function useSources(view: View): string[] {
  const before = useRef<string[]>([]);
  return useMemo(() => {
    const now = [...view.inputs.map((input) => input.name), ...view.blocks.flatMap((other) => other.outputs.map((port) => `${other.name}.${port.name}`))];
    const is_same = now.length === before.current.length && now.every((name, i) => name === before.current[i]);
    return is_same ? before.current : (before.current = now);
  }, [view]);
}
const Options = memo(({ names }: { names: string[] }) => names.map((name) => <option key={name}>{name}</option>));

export function BlockPanel({ block, view }: { block: Block; view: View }) {
  const help = useHelp(block.type), editable = view.editable, chart_is_open = useStudio((state) => state.chart === block.name);
  const sources = useSources(view);
  return (
    <>
      <div className="section">
        <div className="row"><Field value={block.name} label="Name of the block" disabled={!editable} send={(to) => void edit({ intent: "rename_block", name: block.name, to })} /></div>
        <p className="kind">{block.subdiagram ? "Subdiagram" : spaced(block.type)}{block.rate > 0 && <span className="soft"> · every {block.sample_time} s</span>}</p>
        {block.hardware && <p className="hint">A device. <code>loopwright deploy</code> moves it; the studio opens no device, and nothing moves.</p>}
        {(help?.sentence || block.description) && <p className="soft description">{block.description || help?.sentence}</p>}
        {block.variants.length > 0 && (
          <label className="row"><span className="name">variant</span>
            <select value={block.variant} disabled={!editable} onChange={(event) => void edit({ intent: "choose_variant", block: block.name, variant: event.target.value })}>
              {block.variants.map((variant) => <option key={variant}>{variant}</option>)}
            </select></label>
        )}
        <p className="buttons">
          {block.subdiagram && <button type="button" onClick={() => enter(block.name)}>Enter</button>}
          {block.subdiagram && block.file && <button type="button" title="Open the file that defines it, to change it" onClick={() => void open(block.file)}>Open {block.file.split("/").pop()}</button>}
          {editable && <button type="button" onClick={() => void edit({ intent: "duplicate", blocks: [block.name] })}>Duplicate</button>}
          {editable && <button type="button" onClick={() => void edit({ intent: "remove_blocks", blocks: [block.name] })}>Remove</button>}
        </p>
      </div>
      {block.chart && (chart_is_open ? <ChartPanel block={block} /> : <div className="section"><p className="buttons"><button type="button" className="primary" onClick={() => open_chart(block.name)}>Open the chart</button></p>
        <p className="soft small-text">{block.chart.states.length} states, {block.chart.transitions.length} transitions</p></div>)}
      {block.settings.length > 0 && (
        <div className="section">
          <h3>{block.subdiagram ? "Parameters" : "Settings"}</h3>
          <ul className="plain">
            {block.settings.map((setting) => {
              const about = help?.settings.find((entry) => entry.name === setting.name);
              const send = (text: string) => void edit({ intent: "set", block: block.name, setting: setting.name, text });
              return (
                <li key={setting.name} className="parameter" data-setting={setting.name}>
                  <div className="row">
                    <span className="name" title={about?.sentence}>{setting.name}</span>
                    {about?.choices.length
                      ? <select aria-label={setting.name} value={setting.text || about.default} disabled={!editable} onChange={(event) => send(event.target.value)}>{about.choices.map((choice) => <option key={choice}>{choice}</option>)}</select>
                      : <Field value={setting.text} label={`${setting.name} of ${block.name}`} disabled={!editable} send={send} placeholder={about?.default ?? ""} />}
                  </div>
                  {setting.value && setting.text.startsWith("=") && <div className="evaluated">= {prettyUnit(setting.value)}</div>}
                  {setting.slider && <SliderField slider={setting.slider} label={`${setting.name} of ${block.name}`} />}
                </li>
              );
            })}
          </ul>
        </div>
      )}
      <Inputs block={block} view={view} sources={sources} />
      <Outputs block={block} view={view} />
      {help && <details className="section"><summary>About {spaced(block.type)}</summary><pre className="help">{help.help}</pre></details>}
    </>
  );
}

function Inputs({ block, view, sources }: { block: Block; view: View; sources: string[] }) {
  if (!block.inputs.length) return null;
  return (
    <div className="section">
      <h3>Inputs</h3>
      <ul className="plain">
        {block.inputs.flatMap((port) => {
          const to = `${block.name}.${port.name}`;
          const places = Math.max(1, port.wires + (port.many && view.editable ? 1 : 0));
          return Array.from({ length: port.wires ? places : 1 }, (_, index) => {
            const wire = view.wires.find((entry) => entry.to === to && entry.index === index);
            return (
              <li key={`${port.name}${index}`} className="row">
                <span className="name" title={port.sentence}>{port.name}{port.many && index < port.wires ? ` ${index + 1}` : ""}{port.unit && <span className="unit"> {prettyUnit(port.unit)}</span>}</span>
                <select aria-label={`Source of ${to}${port.many ? ` ${index + 1}` : ""}`} value={wire?.from ?? ""} disabled={!view.editable}
                  onChange={(event) => void edit(event.target.value ? { intent: "connect", from: event.target.value, to, index } : { intent: "disconnect", to, index })}>
                  <option value="">{port.wires ? (port.many ? "+ another" : "not connected") : "not connected"}</option>
                  {wire && !sources.includes(wire.from) && <option>{wire.from}</option>}
                  <Options names={sources} />
                </select>
              </li>
            );
          });
        })}
      </ul>
    </div>
  );
}

function Outputs({ block, view }: { block: Block; view: View }) {
  const plots = useStudio((state) => state.plots);
  if (!block.outputs.length) return null;
  return (
    <div className="section">
      <h3>Outputs</h3>
      <ul className="plain">
        {block.outputs.map((port) => {
          const name = signal_name(view.inside, `${block.name}.${port.name}`), shown = plots.some((plot) => plot.includes(name));
          return (
            <li key={port.name} className="row">
              <span className="name" title={port.sentence}>{port.name}{port.unit && <span className="unit"> {prettyUnit(port.unit)}</span>}</span>
              <label><input type="checkbox" checked={shown} onChange={() => void toggle_signal(name)} /> scope</label>
              <label><input type="checkbox" checked={port.logged} disabled={!view.editable || Boolean(view.inside)} onChange={(event) => void edit({ intent: "log", port: name, on: event.target.checked })} /> log</label>
            </li>
          );
        })}
      </ul>
    </div>
  );
}
