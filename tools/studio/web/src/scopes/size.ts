// How high a plot is: all of them share the room, none becomes too flat to read.
import { useEffect, useRef, useState, type RefObject } from "react";

const LEAST = 96, MOST = 300, LEGEND = 24, NUMBERS = 22;  // px

export function usePlotHeight(count: number): { ref: RefObject<HTMLDivElement | null>; height: (is_last: boolean) => number } {
  const ref = useRef<HTMLDivElement>(null), [room, setRoom] = useState(0);
  useEffect(() => {
    const scroller = ref.current?.closest(".plots");
    if (!scroller) return;
    const observer = new ResizeObserver(() => setRoom(scroller.clientHeight));
    observer.observe(scroller);
    return () => observer.disconnect();
  }, []);
  const each = Math.max(LEAST, Math.min(MOST, Math.floor((room - 10 - NUMBERS) / Math.max(1, count)) - LEGEND));
  return { ref, height: (is_last) => each + (is_last ? NUMBERS : 0) };
}
