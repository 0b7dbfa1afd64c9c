import { defineConfig } from "vitest/config";

// MANSARD_DEV is the address of a running `mansard serve`. Open the address of vite with the #token=… of that server.
const served = process.env.MANSARD_DEV ?? "http://127.0.0.1:8642";

export default defineConfig({
  base: "./",
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  build: {
    outDir: process.env.MANSARD_PAGE ?? "dist",
    emptyOutDir: true,
    chunkSizeWarningLimit: 1200,
    assetsInlineLimit: 0, // the content security policy of the server forbids data: for scripts and styles
  },
  // The server accepts only calls from its own origin.
  server: { proxy: { "/api": { target: served, changeOrigin: true, headers: { Origin: served } } } },
  test: { include: ["src/**/*.test.ts"] },
});
