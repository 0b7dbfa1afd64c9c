import { defineConfig } from "vitest/config";

// MANSARD_DEV points the development server at a running `mansard serve`: open vite's address with that one's #token=….
const served = process.env.MANSARD_DEV ?? "http://127.0.0.1:8642";

export default defineConfig({
  base: "./",
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  build: {
    outDir: process.env.MANSARD_PAGE ?? "dist",
    emptyOutDir: true,
    chunkSizeWarningLimit: 1200,
    assetsInlineLimit: 0, // the server's content security policy has no data: for scripts and styles
  },
  // The server takes only calls that come from its own address.
  server: { proxy: { "/api": { target: served, changeOrigin: true, headers: { Origin: served } } } },
  test: { include: ["src/**/*.test.ts"] },
});
