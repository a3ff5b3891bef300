// All problems of the file; each leads to its place.
import { jump_to } from "../state/document";
import { useStudio } from "../state/store";

export function Problems() {
  const problems = useStudio((state) => state.document?.problems);
  const path = useStudio((state) => state.document?.path);
  if (!problems?.length) return <p className="empty">No problems.</p>;
  return (
    <ul className="plain problems">
      {problems.map((problem, i) => (
        <li key={i}>
          <button type="button" className={`problem ${problem.severity}`} onClick={() => void jump_to(problem)}>
            <span className="where">{problem.file === path ? "" : `${problem.file}:`}{problem.line}:{problem.column}{problem.block && ` · ${problem.block}${problem.port ? "." + problem.port : ""}`}</span>
            <b><span className="hidden">{problem.severity}: </span>{problem.message}</b>
            {problem.hint && <span className="problem-hint">{problem.hint}</span>}
          </button>
        </li>
      ))}
    </ul>
  );
}
