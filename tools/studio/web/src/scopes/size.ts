// How high a plot is: all of them share the room, none becomes too flat to read.
import { useEffect, useRef, useState, type RefObject } from "react";

export const LEGEND_HEIGHT = 24, NUMBERS_HEIGHT = 22;  // px
const LEAST = 70, MOST = 300;  // px

/** The height of what scrolls around an element. */
export function useRoom(): { ref: RefObject<HTMLDivElement | null>; room: number } {
  const ref = useRef<HTMLDivElement>(null), [room, setRoom] = useState(0);
  useEffect(() => {
    const scroller = ref.current?.closest(".plots");
    if (!scroller) return;
    const observer = new ResizeObserver(() => setRoom(scroller.clientHeight));
    observer.observe(scroller);
    return () => observer.disconnect();
  }, []);
  return { ref, room };
}

export function usePlotHeight(count: number): { ref: RefObject<HTMLDivElement | null>; height: (is_last: boolean) => number } {
  const { ref, room } = useRoom();
  const each = Math.max(LEAST, Math.min(MOST, Math.floor((room - 10 - NUMBERS_HEIGHT) / Math.max(1, count)) - LEGEND_HEIGHT));
  return { ref, height: (is_last) => each + (is_last ? NUMBERS_HEIGHT : 0) };
}
