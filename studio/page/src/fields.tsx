import type { JSX } from "preact";
import { useRef } from "preact/hooks";
import * as three from "three";

/** A comma between digits is a decimal point: browsers of many languages drop it, and 1,5 would be 15. */
function takeCommaAsPoint(event: JSX.TargetedInputEvent<HTMLInputElement>): void {
  const text = event.data ?? "";
  if (!/^[^.,]*,[^.,]*$/.test(text)) return;
  event.preventDefault();
  document.execCommand("insertText", false, text.replace(",", ".")); // as if it were typed: the browser can undo it
}

/** An input of a number, as the browser has it but for commas. */
export function NumberInput(properties: JSX.IntrinsicElements["input"]) {
  return <input {...properties} type="number" onBeforeInput={takeCommaAsPoint} />;
}

/** A number that the text holds: `onInput` while it is changed, `onDone` when that is over. */
export function NumberField({ label, value, unit, step, least, hasOwnUnit = false, onInput, onDone }: {
  label: string;
  value: number;
  unit: string;
  step: number;
  least?: number;
  hasOwnUnit?: boolean; // which stands beside its name
  onInput: (value: number) => void;
  onDone: () => void;
}) {
  const shown = Number.isFinite(value) ? String(value) : "", latest = useRef(shown), named = unit ? `${label} [${unit}]` : label;
  latest.current = shown;
  return (
    <label class="number-field">
      <span>{hasOwnUnit ? named : label}</span>
      <NumberInput step={step} value={shown} aria-label={named}
        onInput={(e) => {
          const number = e.currentTarget.valueAsNumber;
          // Not by the input's own least: its arrow keys would count steps from there.
          if (Number.isFinite(number) && !(number < (least ?? -Infinity))) onInput(number);
        }}
        onChange={onDone}
        onBlur={({ currentTarget: field }) => setTimeout(() => {
          if (document.activeElement !== field && field.value !== latest.current) field.value = latest.current; // what was refused goes again
        })} />
    </label>
  );
}

/** Three numbers of a place, a size or a direction. */
export function VectorField({ label, value, unit, step, names = ["x", "y", "z"], least, onInput, onDone }: {
  label: string;
  value: number[];
  unit: string;
  step: number;
  names?: string[];
  least?: number;
  onInput: (value: number[]) => void;
  onDone: () => void;
}) {
  return (
    <fieldset class="vector">
      <legend>{label} <small>{unit}</small></legend>
      <div>
        {value.map((x, i) => (
          <NumberField key={names[i]} label={names[i]} value={x} unit={unit} step={step} least={least} onDone={onDone}
            onInput={(changed) => onInput(value.map((old, k) => (k === i ? changed : old)))} />
        ))}
      </div>
    </fieldset>
  );
}

export function vectorOf(numbers: number[]): three.Vector3 {
  return new three.Vector3(...numbers);
}
