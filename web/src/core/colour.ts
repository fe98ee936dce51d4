// Colour maps, computed from a few anchors in OKLab so that equal steps of the
// value look like equal steps of colour (B. Ottosson, "A perceptual color space
// for image processing", 2020). Lightness rises evenly, so that they read alike
// without red-green vision and in print.

export type Rgb = [number, number, number];

/** OKLab lightness, chroma and hue in degrees. */
type Lch = [number, number, number];

export type MapName = "sequential" | "blue_yellow" | "diverging" | "alarm";

export const MAP_LABELS: Record<MapName, string> = {
  sequential: "Dark to light",
  blue_yellow: "Blue to yellow",
  diverging: "Below and above zero",
  alarm: "None to many",
};

const ANCHORS: Record<MapName, Lch[]> = {
  // Violet, blue, green, yellow: hue turns one way while lightness rises.
  sequential: [
    [0.36, 0.13, 295],
    [0.49, 0.115, 262],
    [0.63, 0.098, 215],
    [0.765, 0.13, 160],
    [0.93, 0.16, 105],
  ],
  // Through grey: the only two hues that every kind of colour vision tells apart.
  blue_yellow: [
    [0.35, 0.1, 262],
    [0.53, 0.04, 262],
    [0.71, 0.06, 95],
    [0.93, 0.13, 98],
  ],
  // Blue below zero, orange above, light in the middle.
  diverging: [
    [0.36, 0.12, 255],
    [0.65, 0.1, 245],
    [0.95, 0.008, 90],
    [0.7, 0.13, 55],
    [0.42, 0.13, 38],
  ],
  // Yellow to dark red for what must not be; what is not there stays plain.
  alarm: [
    [0.87, 0.15, 95],
    [0.72, 0.17, 60],
    [0.55, 0.19, 33],
    [0.36, 0.14, 25],
  ],
};

/** The colour of nothing in the map "None to many": that of an uncoloured model. */
const NONE: Rgb = [0.86, 0.87, 0.88];

/** Eight colours for classes: those of Okabe and Ito (2008), told apart by all. */
export const CLASSES: Rgb[] = [
  [0.9, 0.62, 0],
  [0.34, 0.71, 0.91],
  [0, 0.62, 0.45],
  [0.94, 0.89, 0.26],
  [0, 0.45, 0.7],
  [0.84, 0.37, 0],
  [0.8, 0.47, 0.65],
  [0.55, 0.55, 0.55],
];

/** OKLab of a colour in linear light. */
export function oklab([r, g, b]: Rgb): Rgb {
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

/** Linear light of an OKLab colour; may leave [0, 1] where no screen shows it. */
export function fromOklab([lightness, a, b]: Rgb): Rgb {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

/** sRGB from linear light, clamped to what a screen shows. */
export function encode(linear: Rgb): Rgb {
  return linear.map((c) => {
    const x = Math.min(1, Math.max(0, c));
    return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
  }) as Rgb;
}

/** Linear light from sRGB. */
export function decode(srgb: Rgb): Rgb {
  return srgb.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)) as Rgb;
}

/** The colour of `t` in [0, 1], sRGB. */
export function colourAt(map: MapName, t: number): Rgb {
  if (map === "alarm" && t < 0.5 / 255) return NONE;
  const anchors = ANCHORS[map];
  const place = Math.min(1, Math.max(0, t)) * (anchors.length - 1);
  const index = Math.min(anchors.length - 2, Math.floor(place));
  const from = cartesian(anchors[index] as Lch);
  const to = cartesian(anchors[index + 1] as Lch);
  const mix = from.map((c, k) => c + (place - index) * ((to[k] as number) - c)) as Rgb;
  return encode(fromOklab(mix));
}

function cartesian([lightness, chroma, hue]: Lch): Rgb {
  const angle = (hue * Math.PI) / 180;
  return [lightness, chroma * Math.cos(angle), chroma * Math.sin(angle)];
}

/** 256 RGBA bytes of a map, for a texture or a gradient. */
export function mapBytes(map: MapName): Uint8Array {
  const bytes = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; i += 1) {
    const colour = colourAt(map, i / 255);
    colour.forEach((c, k) => {
      bytes[4 * i + k] = Math.round(255 * c);
    });
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}

/** CSS gradient of a map, left to right. */
export function mapGradient(map: MapName): string {
  const stops = Array.from({ length: 17 }, (_, i) => css(colourAt(map, i / 16)));
  return `linear-gradient(to right, ${stops.join(", ")})`;
}

/** CSS of an sRGB colour. */
export function css(colour: Rgb): string {
  return `rgb(${colour.map((c) => Math.round(255 * c)).join(" ")})`;
}

/** WCAG contrast ratio of two sRGB colours, 1 to 21. */
export function contrast(a: Rgb, b: Rgb): number {
  const [light, dark] = [luminance(a), luminance(b)].sort((x, y) => y - x) as [number, number];
  return (light + 0.05) / (dark + 0.05);
}

function luminance(srgb: Rgb): number {
  const [r, g, b] = decode(srgb);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}
