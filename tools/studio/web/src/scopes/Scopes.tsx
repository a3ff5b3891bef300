// The scopes below the diagram: the run, the comparison with a record, the linear analysis, the sweep.
import { useRef } from "react";
import { forget_overrides, pin_run, save_data, zoom } from "../state/run";
import { get, patch, useStudio, type ScopeTab } from "../state/store";
import { save_picture } from "./picture";
import { Boundary } from "../Boundary";
import { settings_text } from "../state/request";
import { CompareScopes } from "./CompareScopes";
import { LinearScopes } from "./LinearScopes";
import { RunScopes } from "./RunScopes";
import { SweepScopes } from "./SweepScopes";
import { CursorTable } from "./CursorTable";

const TABS: { tab: ScopeTab; title: string }[] = [{ tab: "run", title: "Run" }, { tab: "compare", title: "Measured" }, { tab: "linear", title: "Bode" }, { tab: "sweep", title: "Sweep" }];

function toggle_cursors(): void {
  const { cursors, range, run, comparison, scope_tab } = get();
  if (cursors) { patch({ cursors: null }); return; }
  const x = (scope_tab === "compare" ? comparison?.signals[0]?.x : run?.signals[0]?.x) ?? [];
  const from = range?.from ?? x[0] ?? 0, to = range?.to ?? x.at(-1) ?? 1;
  patch({ cursors: { a: from + (to - from) / 3, b: from + (2 * (to - from)) / 3 } });
}

export function Scopes() {
  const area = useRef<HTMLDivElement>(null);
  const tab = useStudio((state) => state.scope_tab);
  const run = useStudio((state) => state.run);
  const comparison = useStudio((state) => state.comparison);
  const linear = useStudio((state) => state.linear);
  const sweep = useStudio((state) => state.sweep);
  const range = useStudio((state) => state.range);
  const cursors = useStudio((state) => state.cursors);
  const overrides = useStudio((state) => state.overrides);
  const available = { run: true, compare: comparison, linear, sweep };
  const source = tab === "compare" && comparison ? `comparison:${comparison.comparison}` : run ? `run:${run.run}` : "";
  const changed = Object.keys(overrides).length;
  return (
    <section className="scopes" aria-label="Scopes">
      <header className="bar">
        <div role="tablist" aria-label="What the scopes show" className="tabs">
          {TABS.filter((entry) => available[entry.tab]).map((entry) => (
            <button key={entry.tab} role="tab" type="button" aria-selected={tab === entry.tab} onClick={() => patch({ scope_tab: entry.tab })}>{entry.title}</button>
          ))}
        </div>
        {tab === "run" && run && <span className="facts">{run.status === "finished" ? `${(1000 * run.wall).toFixed(run.wall < 0.01 ? 1 : 0)} ms of computing` : "failed"}</span>}
        {changed > 0 && <button type="button" className="chip" title={`${settings_text(overrides)}: back to the numbers of the file`} onClick={forget_overrides}>{changed} changed by slider · reset</button>}
        <span className="gap" />
        {range && <button type="button" onClick={() => void zoom(null)} title="Show everything (0)">Whole range</button>}
        {(tab === "run" || tab === "compare") && <button type="button" aria-pressed={Boolean(cursors)} onClick={toggle_cursors} title="Cursors A and B">A B</button>}
        {tab === "run" && <button type="button" onClick={pin_run} disabled={!run} title="Keep this run in the scopes, to compare later ones with it">Keep</button>}
        {(tab === "run" || tab === "compare") && source && (
          <>
            <button type="button" onClick={() => save_picture(area.current!, "scopes.png")} title="Save the scopes as a picture">PNG</button>
            <button type="button" onClick={() => void save_data(source, tab === "run" ? get().plots.flat() : [], `scopes_${tab}.csv`)} title="Save the data of what is seen beside the diagram">CSV</button>
          </>
        )}
      </header>
      <div className="plots" ref={area}>
        <Boundary key={tab} part="This scope">
          {tab === "run" && <RunScopes />}
          {tab === "compare" && <CompareScopes />}
          {tab === "linear" && <LinearScopes />}
          {tab === "sweep" && <SweepScopes />}
        </Boundary>
      </div>
      {cursors && source && <CursorTable source={source} tab={tab} />}
    </section>
  );
}
