import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import type { Player } from "./player";
import type { TimelineData } from "./protocol";
import { seconds } from "./text";

export interface Mark {
  time: number; // of stage 0 [s]
  kind: string;
  text: string;
}

interface Row {
  title: string;
  unit: string;
  scale: number; // of the values of the timeline
  of(data: TimelineData): number[];
}

const kRows: Row[] = [
  { title: "force", unit: "N", scale: 1, of: (data) => data.force_n },
  { title: "depth", unit: "mm", scale: 1e3, of: (data) => data.depth_m },
  { title: "speed", unit: "mm/s", scale: 1e3, of: (data) => data.speed_m_per_s },
];
const kAxis = 64, kRight = 14, kHeight = 54; // [px]
const kPoints = 3000; // of a curve
const kFirst = "#7cc0ff", kSecond = "#ffb35c", kDifference = "#c9a2ff";

/** The value of a timeline at a time; null outside of the session. */
function valueAt(values: number[], duration: number, time: number): number | null {
  if (time < 0 || time > duration || values.length === 0) return null;
  return values[Math.min(values.length - 1, Math.floor((time / duration) * values.length))];
}

function options(width: number, colours: string[]): uPlot.Options {
  const axis = { stroke: "#aab2bd", font: "11px ui-monospace, monospace", grid: { stroke: "#262b33", width: 1 }, ticks: { show: false } };
  return {
    width, height: kHeight, legend: { show: false }, cursor: { show: false }, padding: [4, kRight, 2, 0],
    scales: { x: { time: false }, y: { range: (_, least, most) => [Math.min(0, least), most > least ? most * 1.05 : 1] } },
    axes: [
      { ...axis, show: false },
      { ...axis, size: kAxis, splits: (u) => {
        const { min = 0, max = 1 } = u.scales.y;
        return min < -0.1 * max ? [min, 0, max / 1.05] : [0, max / 1.05];
      }, values: (_, splits) => splits.map((v) => String(Number(v.toPrecision(2)))), gap: 4 },
    ],
    series: [{}, ...colours.map((stroke) => ({ stroke, width: 1.25, points: { show: false }, spanGaps: false }))],
  };
}

/** Force, depth and speed over the whole session, with its events; a press anywhere moves there. */
export function Timeline({ player, marks, version }: { player: Player; marks: Mark[]; version: number }) {
  const box = useRef<HTMLDivElement>(null), head = useRef<HTMLDivElement>(null), slider = useRef<HTMLInputElement>(null);
  const first = player.tracks.get(0)?.timeline ?? null, second = player.tracks.get(1)?.timeline ?? null;
  const { from, to } = player.span, offset = player.offset;
  const shareOf = (time: number) => (to > from ? (time - from) / (to - from) : 0);

  useEffect(() => {
    const holder = box.current;
    if (!holder || !first) return;
    const step = (to - from) / kPoints;
    const times = Array.from({ length: kPoints }, (_, i) => from + (i + 0.5) * step);
    const plots: uPlot[] = [];
    const add = (title: string, series: (number | null)[][], colours: string[]) => {
      const row = holder.appendChild(document.createElement("div"));
      row.dataset.title = title;
      plots.push(new uPlot(options(holder.clientWidth, colours.slice(0, series.length)), [times, ...series], row));
    };
    const isEmpty = (data: TimelineData | null, row: Row) => !data || row.of(data).every((value) => value === 0);
    for (const row of kRows) {
      if (isEmpty(first, row) && isEmpty(second, row)) continue; // a blade has no depth
      const over = (data: TimelineData, ahead: number) => times.map((t) => {
        const value = valueAt(row.of(data), data.duration_s, t + ahead);
        return value === null ? null : value * row.scale;
      });
      const series = [over(first, 0)];
      if (second) series.push(over(second, offset));
      add(`${row.title} [${row.unit}]`, series, [kFirst, kSecond]);
    }
    if (second)
      add("difference of force [N]", [times.map((t) => {
        const own = valueAt(first.force_n, first.duration_s, t), other = valueAt(second.force_n, second.duration_s, t + offset);
        return own === null || other === null ? null : other - own;
      })], [kDifference]);
    const observer = new ResizeObserver(() => {
      for (const plot of plots) plot.setSize({ width: holder.clientWidth, height: kHeight });
    });
    observer.observe(holder);
    return () => {
      observer.disconnect();
      for (const plot of plots) plot.destroy();
      holder.replaceChildren();
    };
  }, [first, second, from, to, offset]);

  useEffect(() => {
    const place = () => {
      const share = shareOf(player.time);
      head.current?.style.setProperty("--at", String(share));
      if (slider.current && document.activeElement !== slider.current) slider.current.value = String(player.time);
      slider.current?.setAttribute("aria-valuetext", seconds(player.time));
    };
    place();
    const timer = setInterval(place, 40);
    return () => clearInterval(timer);
  }, [player, from, to, version]);

  const shareAt = (event: PointerEvent) => {
    const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
    return (event.clientX - box.left - kAxis) / (box.width - kAxis - kRight);
  };
  const press = (event: PointerEvent) => {
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    player.pause();
    player.move(from + shareAt(event) * (to - from));
  };
  const drag = (event: PointerEvent) => {
    if (event.buttons & 1) player.move(from + shareAt(event) * (to - from));
  };

  return (
    <div class="timeline" role="group" aria-label="Timeline">
      <div class="marks" aria-hidden="true">
        {marks.map((mark, i) => (
          <button key={i} type="button" tabIndex={-1} class={`mark ${mark.kind.replaceAll(" ", "-")}`} title={`${seconds(mark.time)} ${mark.text}`}
            style={{ "--at": String(shareOf(mark.time)) }} onClick={() => player.move(mark.time)} />
        ))}
      </div>
      <div class="plots" onPointerDown={press} onPointerMove={drag}>
        <div ref={box} />
        <div ref={head} class="playhead" />
      </div>
      <input ref={slider} class="scrub" type="range" min={from} max={to} step={0.001} aria-label="Moment of the session"
        onInput={(event) => {
          player.pause();
          player.move(Number(event.currentTarget.value));
        }} />
    </div>
  );
}
