// Colours of the 3D view for dark and light pages, sRGB.
export type ThemeName = "dark" | "light";

export type ViewTheme = {
  background: string;
  front: string;
  back: string;
  edge: string;
  unknown: string;
  pick: string;
  arrow: string;
  gridMinor: string;
  gridMajor: string;
};

export const VIEW_THEMES: Record<ThemeName, ViewTheme> = {
  dark: {
    background: "#1b1e22",
    front: "#c9ced6",
    back: "#b08b74",
    edge: "#15181b",
    unknown: "#6b6f76",
    pick: "#ff66b8",
    arrow: "#4cc2ff",
    gridMinor: "#292d33",
    gridMajor: "#3d434b",
  },
  light: {
    background: "#f2f3f5",
    front: "#e3e5e9",
    back: "#dcb89f",
    edge: "#2a2e34",
    unknown: "#9aa0a8",
    pick: "#d6007a",
    arrow: "#0067a8",
    gridMinor: "#e0e2e6",
    gridMajor: "#c3c8cf",
  },
};
