// Icons of buttons. Screen readers use the labels of the buttons.
const paths = {
  home: "M3 11 12 4l9 7M6 9.5V20h12V9.5",
  top: "M4 4h16v16H4zM4 12h16M12 4v16",
  focus: "M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5M9 12a3 3 0 1 0 6 0 3 3 0 1 0-6 0",
  section: "M4 18 12 21l8-3V6l-8-3-8 3zM12 3v18M12 8l8-2M12 13l8-2M12 18l8-2",
  layers: "M12 3 3 8l9 5 9-5zM3 12.5l9 5 9-5M3 17l9 5 9-5",
  undo: "M8 5 3 10l5 5M3 10h11a6 6 0 0 1 0 12h-3",
  redo: "m16 5 5 5-5 5M21 10H10a6 6 0 0 0 0 12h3",
  close: "M5 5l14 14M19 5 5 19",
  more: "M5 12h.01M12 12h.01M19 12h.01",
  pencil: "M4 20l1-5L16 4l4 4L9 19z",
  bin: "M4 7h16M9 7V4h6v3M6 7l1 13h10l1-13",
  help: "M9 9a3 3 0 1 1 4.5 2.6c-1 .6-1.5 1.2-1.5 2.4M12 18h.01",
  ruler: "M3 15 15 3l6 6L9 21zM7 11l2 2M10 8l3 3M13 5l2 2",
  pairs: "M4 18 14 8M11 8h3v3M4 18h.01M3 21h2v-2M17 3h4v4M17 21h4v-4M21 12v2",
  divide: "M12 3v18M4 7h5v10H4zM15 7h5v10h-5z",
  camera: "M4 8h4l2-3h4l2 3h4v11H4zM9 13a3 3 0 1 0 6 0 3 3 0 1 0-6 0",
  moon: "M20 14A8 8 0 0 1 10 4a8 8 0 1 0 10 10z",
  sun: "M8 12a4 4 0 1 0 8 0 4 4 0 1 0-8 0M12 2v3M12 19v3M2 12h3M19 12h3M5 5l2 2M17 17l2 2M5 19l2-2M17 7l2-2",
  flip: "M12 3v18M8 7 3 12l5 5M16 7l5 5-5 5",
} as const;

export function Icon({ name }: { name: keyof typeof paths }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true">
      <path d={paths[name]} />
    </svg>
  );
}
