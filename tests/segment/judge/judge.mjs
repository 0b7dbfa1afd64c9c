// node judge.mjs DIR: HiGHS solves every program of DIR/expected.json. Fails unless it proves each of them optimal
// at the objective that is expected, to seven digits, and unless the programs are many and of all sizes. What the
// segmentation states, from its labels alone, may differ by one rounding a candidate.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import loadHighs from 'highs';

const fewest = 20, small = 10, large = 400;
const digits = 7;

/** HiGHS's verdict: { optimal, objective, nodes }. It has one thread. Costs are whole: a gap under 1 is none. */
function solved(highs, data) {
  return highs.withModel({ format: 'mps', data }, (model) => {
    model.options.set({ output_flag: false, mip_rel_gap: 0, mip_abs_gap: 0.5 });
    model.run();
    return {
      optimal: model.getModelStatus() === highs.constants.modelStatus.optimal,
      objective: model.getObjectiveValue(),
      nodes: model.info.get('mip_node_count'),
    };
  });
}

function agree(one, other) {
  return Math.abs(one - other) <= 0.5 * 10 ** (1 - digits) * Math.max(Math.abs(one), 1);
}

function judge(highs, folder) {
  const complaints = [];
  const expected = JSON.parse(readFileSync(join(folder, 'expected.json'), 'utf8'));
  console.log(
    'program     | faces | variables |  rows |      objective |            HiGHS | nodes | block         | options');
  for (const [file, ours] of Object.entries(expected)) {
    const theirs = solved(highs, readFileSync(join(folder, file)));
    if (ours.status !== 'optimal') complaints.push(`${file}: the segmentation is ${ours.status}, not optimal`);
    if (!theirs.optimal) complaints.push(`${file}: HiGHS did not prove an optimum`);
    if (!agree(ours.objective, theirs.objective))
      complaints.push(`${file}: the segmentation costs ${ours.objective}, HiGHS finds ${theirs.objective}`);
    if (Math.abs(theirs.objective - 1000 * ours.stated) > ours.candidates + 1)
      complaints.push(`${file}: the segmentation states ${ours.stated}, HiGHS finds ${theirs.objective} / 1000`);
    const columns = [[file, -11], [ours.faces, 5], [ours.variables, 9], [ours.rows, 5], [ours.objective, 14],
      [theirs.objective, 16], [theirs.nodes, 5], [ours.block, -13], [ours.options, -1]];
    console.log(columns.map(([v, n]) => (n < 0 ? String(v).padEnd(-n) : String(v).padStart(n))).join(' | '));
  }
  const faces = Object.values(expected).map((block) => block.faces);
  if (faces.length < fewest) complaints.push(`only ${faces.length} programs, not ${fewest}`);
  if (Math.min(...faces) >= small) complaints.push(`no block of fewer than ${small} faces`);
  if (Math.max(...faces) < large) complaints.push(`no block of ${large} faces`);
  console.log(`${faces.length} programs of ${Math.min(...faces)} to ${Math.max(...faces)} inside faces`);
  return complaints;
}

try {
  const complaints = judge(await loadHighs(), process.argv[2]);
  for (const complaint of complaints) console.error(complaint);
  process.exitCode = complaints.length === 0 ? 0 : 1;
} catch (error) {
  // Uncaught, node would print the package's line: 150 kB.
  console.error(error.message);
  process.exitCode = 1;
}
