// Input fields that send what was typed when it is complete, and sliders that run the diagram while they move.
import { useEffect, useId, useRef, useState } from "react";
import type { Slider } from "../protocol/types";
import { open } from "../state/document";
import { begin_sliding, end_sliding, forget_override, keep_override, slide } from "../state/run";
import { useStudio } from "../state/store";
import { prettyUnit, quantity } from "../numbers";
import { FitChoice } from "./Fit";

/** Sends on Enter and on leaving; Escape brings back what was there, and so does leaving after a refusal. */
export function Field({ value, label, send, disabled, mono, placeholder }: { value: string; label: string; send: (text: string) => void; disabled?: boolean; mono?: boolean; placeholder?: string }) {
  const [text, setText] = useState(value), sent = useRef<string | null>(null);
  useEffect(() => { setText(value); sent.current = null; }, [value]);
  const done = () => { if (text !== value) { sent.current = text; send(text); } };
  const leave = () => { if (text === sent.current) setText(value); else done(); };
  return (
    <input className={mono === false ? "field" : "field mono"} value={text} aria-label={label} disabled={disabled} spellCheck={false} placeholder={placeholder}
      onChange={(event) => setText(event.target.value)} onBlur={leave}
      onKeyDown={(event) => {
        if (event.key === "Enter") done();
        if (event.key === "Escape") setText(value);
      }} />
  );
}

const STEPS = 400;  // of a slider from end to end

export function SliderField({ slider, label }: { slider: Slider; label: string }) {
  const override = useStudio((state) => state.overrides[slider.set]);
  const editable = useStudio((state) => state.document?.view?.editable ?? false), file_inside = useStudio((state) => state.file_inside);
  const id = useId();
  const logarithmic = slider.logarithmic && slider.low > 0;
  const to_place = (value: number) => logarithmic ? Math.log(value / slider.low) / Math.log(slider.high / slider.low) : (value - slider.low) / (slider.high - slider.low);
  const to_value = (place: number) => {
    const value = logarithmic ? slider.low * (slider.high / slider.low) ** place : slider.low + place * (slider.high - slider.low);
    return +value.toPrecision(4);
  };
  const given = override === undefined ? slider.value : parseFloat(override);
  const value = Number.isFinite(given) ? given : slider.value;
  return (
    <div className={override === undefined ? "slider" : "slider changed"}>
      <input id={id} type="range" min={0} max={STEPS} step={1} value={Math.round(STEPS * Math.max(0, Math.min(1, to_place(value))))} aria-label={`${label}, slider`}
        aria-valuetext={`${value} ${slider.unit}`} data-set={slider.set}
        onPointerDown={begin_sliding} onPointerUp={end_sliding} onFocus={begin_sliding} onBlur={end_sliding}
        onChange={(event) => slide(slider, to_value(Number(event.target.value) / STEPS))} />
      <FitChoice set={slider.set} label={label} />
      {override !== undefined && (
        <div className="override">
          <output htmlFor={id}>{+value.toPrecision(4)} {prettyUnit(slider.unit)}</output><span className="soft">not in the file</span>
          {editable && <button type="button" className="small" title="Write this number into the file" onClick={() => void keep_override(slider.set)}>Write</button>}
          {!editable && file_inside && <button type="button" className="small" title={`${file_inside} defines this number: open it to change it there`} onClick={() => void open(file_inside)}>Open {file_inside.split("/").pop()}</button>}
          <button type="button" className="small" title={`Back to the file's ${quantity(slider.value, slider.unit)}`} aria-label={`Reset ${label}`} onClick={() => forget_override(slider.set)}>Reset</button>
        </div>
      )}
    </div>
  );
}
