// The force as a sound: higher and louder the more the tissue resists.

const kLow = 160, kOctaves = 2; // pitch without force [Hz], and how far it rises up to the limit
const kLoudest = 0.12;
const kSmooth = 0.03; // time in which the sound follows [s]

export class ForceSound {
  private context: AudioContext | null = null;
  private pitch: OscillatorNode | null = null;
  private loudness: GainNode | null = null;

  get isOn(): boolean {
    return this.context !== null;
  }

  /** Browsers allow it after a press of a key or button. */
  switch(): void {
    if (this.context) return this.end();
    const context = (this.context = new AudioContext());
    this.pitch = new OscillatorNode(context, { type: "triangle", frequency: kLow });
    this.loudness = new GainNode(context, { gain: 0 });
    this.pitch.connect(this.loudness).connect(context.destination);
    this.pitch.start();
  }

  /** Sounds a force as a share of the one that does harm. */
  sound(share: number): void {
    if (!this.context) return;
    const heard = Math.min(share, 1), now = this.context.currentTime;
    this.pitch!.frequency.setTargetAtTime(kLow * 2 ** (kOctaves * heard), now, kSmooth);
    this.loudness!.gain.setTargetAtTime(kLoudest * Math.sqrt(heard), now, kSmooth);
  }

  end(): void {
    void this.context?.close();
    this.context = this.pitch = this.loudness = null;
  }
}
