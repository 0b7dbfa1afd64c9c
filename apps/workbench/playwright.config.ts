import { defineConfig } from "@playwright/test";

// Browsers of Debian, with WebGL in software: test machines have no graphics card. Playwright drives a Firefox that is not its own
// by WebDriver BiDi, which it calls experimental; tests/run.sh gives it a screen, since WebGL of Firefox needs one.
const firefox = process.env.MANSARD_BROWSER === "firefox";
const chromium = {
  browserName: "chromium" as const,
  launchOptions: {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [
      "--no-sandbox",
      "--enable-unsafe-swiftshader", // for WebGL alone: pages are composed without it, as where there is no graphics card
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  },
};
const mozilla = {
  browserName: "_bidiFirefox" as "firefox", // not among the names that its types know
  headless: false,
  launchOptions: {
    executablePath: process.env.FIREFOX ?? "/usr/bin/firefox-esr",
    firefoxUserPrefs: {
      "browser.download.folderList": 2,
      "browser.download.dir": process.env.MANSARD_DOWNLOADS ?? "",
      "dom.w3c_touch_events.enabled": 1, // also without a touch screen
    },
  },
};

export default defineConfig({
  testDir: "./tests",
  testMatch: "*.spec.ts",
  outputDir: process.env.MANSARD_TEST_RESULTS ?? "test-results",
  fullyParallel: false,
  workers: 1,
  retries: 0,
  timeout: 300_000,
  expect: { timeout: 60_000 },
  reporter: [["list"]],
  use: {
    actionTimeout: 60_000,
    viewport: { width: 1366, height: 768 },
    ...(firefox ? mozilla : chromium),
  },
});
