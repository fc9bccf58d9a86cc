// Has a browser draw pictures: `node run.mjs FOLDER`.
//
// FOLDER holds `jobs.json`, a list of { name, kind, width, height, blockVectors, textureWidth,
// voxelsWidth, mouse }, and for each job NAME.glsl, NAME.f32 and NAME.voxels, which is empty for scenes that are not sampled.
// For each, NAME.rgb is written, bytes from the upper left, and NAME.png, what the page shows; and a line is printed: the name,
// where the parameters were, milliseconds up to the first picture, and milliseconds for another one, with tabs between.

import { chromium } from "playwright-core";
import { accessSync, constants, readFileSync, writeFileSync } from "node:fs";
import { delimiter, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const NAMES = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

// WebGL by software, so that no graphics processor is needed, and nothing that would ask the network.
const FLAGS = [
    "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
    "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];

function isProgram(path) {
    try {
        accessSync(path, constants.X_OK);
        return true;
    } catch {
        return false;
    }
}

// The browser that CHROME_PATH names, or the first one found.
function browserPath() {
    if (process.env.CHROME_PATH) {
        return process.env.CHROME_PATH;
    }
    const folders = (process.env.PATH ?? "").split(delimiter);
    const found = NAMES.flatMap(name => folders.map(folder => join(folder, name))).find(isProgram);
    if (found === undefined) {
        throw new Error(`no Chromium is installed (looked for ${NAMES.join(", ")}); CHROME_PATH can name one`);
    }
    return found;
}

const folder = process.argv[2];
const jobs = JSON.parse(readFileSync(join(folder, "jobs.json"), "utf8"));
const browser = await chromium.launch({ executablePath: browserPath(), headless: true, args: FLAGS });
let failures = 0;
try {
    const page = await browser.newPage();
    await page.goto(pathToFileURL(join(fileURLToPath(new URL(".", import.meta.url)), "page.html")).href);
    for (const job of jobs) {
        const file = ending => join(folder, `${job.name}.${ending}`);
        const numbers = ending => {
            const bytes = readFileSync(file(ending));
            return Array.from({ length: bytes.length / 4 }, (_, i) => bytes.readFloatLE(4 * i));
        };
        const [table, voxels] = ["f32", "voxels"].map(numbers);
        const text = readFileSync(file("glsl"), "utf8");
        try {
            const { bytes: picture, way, first, again } = await page.evaluate(job => draw(job), { ...job, text, table, voxels });
            writeFileSync(file("rgb"), Uint8Array.from(picture));
            await page.locator("#canvas").screenshot({ path: file("png") });
            console.log([job.name, way, first.toFixed(1), again.toFixed(1)].join("\t"));
        } catch (error) {
            failures += 1;
            console.error(`${job.name}: ${error.message}`);
        }
    }
} finally {
    await browser.close();
}
process.exit(failures === 0 ? 0 : 1);
