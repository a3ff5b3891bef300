// The list of keys.
import { useEffect, useRef } from "react";
import { KEYS } from "../state/keys";
import { patch, useStudio } from "../state/store";

export function Commands() {
  const open = useStudio((state) => state.show_commands), dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => { if (open) dialog.current?.showModal(); else dialog.current?.close(); }, [open]);
  return (
    <dialog ref={dialog} className="commands" aria-label="Keys" onClose={() => patch({ show_commands: false })} onClick={(event) => { if (event.target === dialog.current) patch({ show_commands: false }); }}>
      <h2>Keys</h2>
      <table><tbody>{KEYS.map((entry) => <tr key={entry.keys}><th scope="row">{entry.keys}</th><td>{entry.what}</td></tr>)}</tbody></table>
      <p className="buttons"><button type="button" onClick={() => patch({ show_commands: false })}>Close</button></p>
    </dialog>
  );
}
