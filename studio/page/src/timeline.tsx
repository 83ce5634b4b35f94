import { useEffect, useRef, useState } from "preact/hooks";
import uPlot from "uplot";
import { classOf, type Mark, MarkLegend } from "./marks";
import type { Player } from "./player";
import type { TimelineData } from "./protocol";
import { seconds } from "./text";
import { alignedText, ownTime, TimeAxes, Whose } from "./time_axis";

interface Row {
  title: string;
  unit: string;
  scale: number; // of the values of the timeline
  digits: number; // of a value that is written
  of(data: TimelineData): (number | null)[];
}

const kRows: Row[] = [
  { title: "force", unit: "N", scale: 1, digits: 2, of: (data) => data.force_n },
  { title: "depth", unit: "mm", scale: 1e3, digits: 2, of: (data) => data.depth_m },
  { title: "speed", unit: "mm/s", scale: 1e3, digits: 1, of: (data) => data.speed_m_per_s },
];
const kAxis = 64, kRight = 14, kHeight = 58; // [px]
const kPoints = 3000; // of a curve
const kFirst = "#7cc0ff", kSecond = "#ffb35c", kDifference = "#c9a2ff";

const kLeastShown = 0.05; // [s]
const kZoomStep = 1.5;

/** The largest value of a timeline in a span of time; null outside of the session, and where there is none. */
function mostIn(values: (number | null)[], duration: number, from: number, to: number): number | null {
  if (to < 0 || from > duration || values.length === 0) return null;
  const first = Math.max(0, Math.min(values.length - 1, Math.floor((from / duration) * values.length)));
  const last = Math.max(first, Math.min(values.length - 1, Math.ceil((to / duration) * values.length) - 1));
  let most: number | null = null;
  for (let i = first; i <= last; ++i) {
    const value = values[i];
    if (value !== null) most = Math.max(most ?? value, value);
  }
  return most;
}

/** The value at a moment: of the part that ends there, as the picture shows the tick that was done last. */
export function valueAt(values: (number | null)[], duration: number, time: number): number | null {
  const middle = time - duration / values.length / 2;
  return time < 0 ? null : mostIn(values, duration, Math.max(0, middle), Math.max(0, middle));
}

function options(width: number, colours: string[]): uPlot.Options {
  const axis = { stroke: "#aab2bd", font: "11px ui-monospace, monospace", grid: { stroke: "#262b33", width: 1 }, ticks: { show: false } };
  return {
    width, height: kHeight, legend: { show: false }, cursor: { show: false }, padding: [15, kRight, 7, 0], // above, the row's name; numbers of rows below each other stay apart
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

/** Force, depth and speed over the whole session or a part of it, with its events; a press anywhere moves there. */
export function Timeline({ player, marks, version }: { player: Player; marks: Mark[]; version: number }) {
  const box = useRef<HTMLDivElement>(null), head = useRef<HTMLDivElement>(null), slider = useRef<HTMLInputElement>(null);
  const first = player.tracks.get(0)?.timeline ?? null, second = player.tracks.get(1)?.timeline ?? null;
  const { span, offset, path, otherScene } = player;
  const rows = useRef<{ element: HTMLElement; at(): (number | null)[]; digits: number }[]>([]); // what each writes beside its name
  const [, setDrawn] = useState(0);
  const { zoom } = player;
  const setZoom = (to: Player["zoom"]) => (player.zoom = to, setDrawn((n) => n + 1));
  const from = Math.max(zoom?.from ?? span.from, span.from), to = Math.max(Math.min(zoom?.to ?? span.to, span.to), from);
  const shareOf = (time: number) => (to > from ? (time - from) / (to - from) : 0);

  useEffect(() => {
    const holder = box.current;
    if (!holder || !first) return;
    const step = (to - from) / kPoints;
    const times = Array.from({ length: kPoints }, (_, i) => from + (i + 0.5) * step);
    const plots: uPlot[] = [];
    const add = (title: string, series: (number | null)[][], colours: string[], digits: number, at: () => (number | null)[]) => {
      const row = holder.appendChild(document.createElement("div"));
      row.dataset.title = title;
      rows.current.push({ element: row, at, digits });
      plots.push(new uPlot(options(holder.clientWidth, colours.slice(0, series.length)), [times, ...series], row));
    };
    const half = step / 2;
    const isEmpty = (data: TimelineData | null, row: Row) => !data || row.of(data).every((value) => !value);
    for (const row of kRows) {
      if (isEmpty(first, row) && isEmpty(second, row)) continue; // sessions of blades alone have no depth
      const over = (data: TimelineData, timeOf: (time: number) => number) => times.map((t) => {
        const value = mostIn(row.of(data), data.duration_s, timeOf(t - half), timeOf(t + half));
        return value === null ? null : value * row.scale;
      });
      const series = [over(first, (t) => t)];
      if (second) series.push(over(second, (t) => player.besideAt(t)));
      const now = (data: TimelineData, stage: number) => {
        const value = valueAt(row.of(data), data.duration_s, player.timeOf(stage));
        return value === null ? null : value * row.scale;
      };
      add(`${row.title} [${row.unit}]`, series, [kFirst, kSecond], row.digits, () => [now(first, 0), ...(second ? [now(second, 1)] : [])]);
    }
    if (second && !otherScene) {
      const forceAt = (data: TimelineData, stage: number) => valueAt(data.force_n, data.duration_s, player.timeOf(stage));
      add("difference of force [N]", [times.map((t) => {
        const own = mostIn(first.force_n, first.duration_s, t - half, t + half);
        const other = mostIn(second.force_n, second.duration_s, player.besideAt(t - half), player.besideAt(t + half));
        return own === null || other === null ? null : other - own;
      })], [kDifference], 2, () => {
        const own = forceAt(first, 0), other = forceAt(second, 1);
        return [own === null || other === null ? null : other - own];
      });
    }
    const observer = new ResizeObserver(() => {
      for (const plot of plots) plot.setSize({ width: holder.clientWidth, height: kHeight });
    });
    observer.observe(holder);
    return () => {
      observer.disconnect();
      for (const plot of plots) plot.destroy();
      rows.current = [];
      holder.replaceChildren();
    };
  }, [first, second, from, to, offset, path, otherScene]);

  useEffect(() => {
    const place = () => {
      const share = shareOf(player.time);
      head.current?.style.setProperty("--at", String(share));
      if (slider.current && document.activeElement !== slider.current) slider.current.value = String(player.time);
      slider.current?.setAttribute("aria-valuetext",
        player.tracks.has(1) ? `expert ${ownTime(player, 0)}, trainee ${ownTime(player, 1)}` : seconds(player.time));
      for (const { element, at, digits } of rows.current) {
        const text = at().map((value) => (value === null ? "–" : value.toFixed(digits))).join(" · ");
        if (element.dataset.at !== text) element.dataset.at = text;
      }
    };
    place();
    const timer = setInterval(place, 40);
    return () => clearInterval(timer);
  }, [player, from, to, version]);

  /** Shows a part that is so many times as long, around a time. */
  const zoomBy = (factor: number, around: number) => {
    const length = Math.max((to - from) * factor, kLeastShown), whole = span.to - span.from;
    if (length >= (1 - 1e-6) * whole) return setZoom(null);
    const begin = Math.min(Math.max(around - (around - from) * (length / (to - from)), span.from), span.to - length);
    setZoom({ from: begin, to: begin + length });
  };
  const panBy = (time: number) => {
    const by = Math.min(Math.max(time, span.from - from), span.to - to);
    if (by !== 0) setZoom({ from: from + by, to: to + by });
  };
  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    const sideways = event.shiftKey ? event.deltaY : event.deltaX;
    if (Math.abs(sideways) > Math.abs(event.shiftKey ? 0 : event.deltaY)) panBy(Math.sign(sideways) * 0.1 * (to - from));
    else if (event.deltaY !== 0) zoomBy(event.deltaY > 0 ? kZoomStep : 1 / kZoomStep, from + shareAt(event) * (to - from));
  };
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      if ((event.target as HTMLElement).closest("input:not([type=range]), textarea, select") || event.ctrlKey || event.metaKey || event.altKey) return;
      const middle = Math.min(Math.max(player.time, from), to);
      if (event.key === ".") zoomBy(1 / kZoomStep, middle);
      else if (event.key === ",") zoomBy(kZoomStep, middle);
      else if (event.key === "0") setZoom(null);
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  });
  const shareAt = (event: MouseEvent) => {
    const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
    return (event.clientX - box.left - kAxis) / (box.width - kAxis - kRight);
  };
  const grab = (event: PointerEvent) => {
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    player.pause();
    player.move(from + shareAt(event) * (to - from));
  };
  const drag = (event: PointerEvent) => {
    if (event.buttons & 1) player.move(from + shareAt(event) * (to - from));
  };

  return (
    <div class="timeline" role="group" aria-label="Timeline">
      <MarkLegend marks={marks} />
      {[...player.tracks.keys()].sort().map((stage) => (
        <div key={stage} class="marks" aria-hidden="true">
          {player.tracks.has(1) && <Whose stage={stage} />}
          {marks.filter((mark) => mark.stage === stage && mark.time >= from && mark.time <= to).map((mark, i) => (
            <button key={i} type="button" tabIndex={-1} class={classOf(mark)} title={mark.title}
              style={{ "--at": String(shareOf(mark.time)) }} onClick={() => (mark.onPress ?? (() => player.move(mark.time)))()} />
          ))}
        </div>
      ))}
      <div class="plots" onPointerDown={grab} onPointerMove={drag} onWheel={wheel}>
        <div ref={box} />
        <div ref={head} class="playhead" hidden={player.time < from || player.time > to} />
      </div>
      <TimeAxes player={player} from={from} to={to} />
      <div class="zoom" role="group" aria-label="Zoom of the timeline">
        <button type="button" title="full stop, or the wheel" onClick={() => zoomBy(1 / kZoomStep, Math.min(Math.max(player.time, from), to))}>zoom in</button>
        <button type="button" title="comma" disabled={!zoom} onClick={() => zoomBy(kZoomStep, Math.min(Math.max(player.time, from), to))}>zoom out</button>
        {zoom && <button type="button" title="0" onClick={() => setZoom(null)}>all</button>}
        {zoom && <output>{seconds(from)} to {seconds(to)}</output>}
        {player.tracks.has(1) && <span class="aligned">{alignedText(player)}</span>}
      </div>
      <input ref={slider} class="scrub" type="range" min={from} max={to} step={0.001} aria-label="Moment of the session"
        onInput={(event) => {
          player.pause();
          player.move(Number(event.currentTarget.value));
        }} />
    </div>
  );
}
