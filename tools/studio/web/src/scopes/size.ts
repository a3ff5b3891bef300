// How high a plot is: all of them share the room, none becomes too flat to read.
import { useEffect, useState } from "react";

export const LEGEND_HEIGHT = 24, NUMBERS_HEIGHT = 22, VERDICT_HEIGHT = 24;  // px
const LEAST = 70, MOST = 300;  // px

type Ref = (element: HTMLElement | null) => void;

/** The height of what scrolls around an element. */
export function useRoom(): { ref: Ref; room: number } {
  const [element, setElement] = useState<HTMLElement | null>(null), [room, setRoom] = useState(0);
  useEffect(() => {
    const scroller = element?.closest(".plots");
    if (!scroller) return;
    const observer = new ResizeObserver(() => setRoom(scroller.clientHeight));
    observer.observe(scroller);
    return () => observer.disconnect();
  }, [element]);
  return { ref: setElement, room };
}

export function usePlotHeight(count: number, above = 0): { ref: Ref; height: (is_last: boolean) => number } {
  const { ref, room } = useRoom();
  const each = Math.max(LEAST, Math.min(MOST, Math.floor((room - 10 - above - NUMBERS_HEIGHT) / Math.max(1, count)) - LEGEND_HEIGHT));
  return { ref, height: (is_last) => each + (is_last ? NUMBERS_HEIGHT : 0) };
}
