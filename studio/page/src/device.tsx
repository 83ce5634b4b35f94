import { kDeviceKeys, type DeviceChoice } from "./device_choice";

/** What is in the hand: what this page has, or a device that speaks OpenIGTLink. */
export function DeviceForm({ choice, onChoice, isDisabled }: { choice: DeviceChoice; onChoice: (choice: DeviceChoice) => void; isDisabled: boolean }) {
  const field = (label: string, key: keyof DeviceChoice, hint = "") => (
    <label class="field">
      <span>{label}</span>
      <input value={choice[key]} placeholder={hint} disabled={isDisabled} onInput={(e) => onChoice({ ...choice, [key]: e.currentTarget.value })} />
    </label>
  );
  return (
    <>
      <label class="field">
        <span>in the hand</span>
        <select value={choice.how} disabled={isDisabled} onChange={(e) => onChoice({ ...choice, how: e.currentTarget.value as DeviceChoice["how"] })}>
          <option value="">mouse, keys or gamepad</option>
          <option value="listen">a device that connects here</option>
          <option value="connect">a device that is connected to</option>
        </select>
      </label>
      {choice.how === "listen" && field("port of this machine, OpenIGTLink", "port")}
      {choice.how === "connect" && field("its server, OpenIGTLink", "address", "tracker:18944")}
      {choice.how && (
        <details>
          <summary>How it lies in the scene</summary>
          {kDeviceKeys.map(([key, label, hint]) => field(label, key, hint))}
        </details>
      )}
    </>
  );
}
