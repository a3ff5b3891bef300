// A fault of one part of the page takes that part away, not the page: it says what failed and offers to go on.
import { Component, type ReactNode } from "react";

interface Props { part: string; children: ReactNode }

export class Boundary extends Component<Props, { fault: Error | null }> {
  override state = { fault: null as Error | null };
  static getDerivedStateFromError(fault: unknown) { return { fault: fault instanceof Error ? fault : new Error(String(fault)) }; }
  override render() {
    const { fault } = this.state;
    if (!fault) return this.props.children;
    return (
      <div className="broken-part" role="alert">
        <p><b>{this.props.part} cannot be shown.</b> The file is not affected.</p>
        <p className="soft mono">{fault.message}</p>
        <p className="buttons">
          <button type="button" onClick={() => this.setState({ fault: null })}>Try again</button>
          <button type="button" onClick={() => location.reload()}>Reload the page</button>
        </p>
      </div>
    );
  }
}
