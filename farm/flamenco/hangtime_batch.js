// SPDX-License-Identifier: GPL-3.0-or-later
//
// Flamenco job type: a Hangtime batch, in tasks of a few cells each, and one that collects.
// Put this file into the folder `scripts` beside flamenco-manager; docs/manual/farm.md has the rest.

const JOB_TYPE = {
    label: "Hangtime Batch",
    description: "Solve the cells of a planned batch of motions, and collect them",
    settings: [
        { key: "batch_folder", type: "string", subtype: "dir_path", required: true,
          description: "Folder of the batch, with manifest.jsonl, as all workers see it" },
        { key: "cells", type: "string", required: true,
          description: "Cells to solve, by their places in the manifest. Examples: '7', '1-600', '3, 5-10'" },
        { key: "cells_per_task", type: "int32", default: 1, propargs: { min: 1 }, visible: "submission",
          description: "Cells that one task solves; more of them start the program less often" },
        { key: "program", type: "string", default: "hangtime-batch", visible: "submission",
          description: "The program on the workers, or a variable of the Manager's for it" },
    ]
};

function compileJob(job) {
    const settings = job.settings;
    const collect = author.Task("collect", "misc");
    collect.addCommand(run(settings, ["collect", settings.batch_folder]));

    const chunks = frameChunker(settings.cells, settings.cells_per_task || 1);
    for (let i = 0; i < chunks.length; i++) {
        const task = author.Task("cells-" + chunks[i], "misc");
        task.addCommand(run(settings, ["task", settings.batch_folder, chunks[i]]));
        job.addTask(task);
        collect.addDependency(task);
    }
    job.addTask(collect); // last: the Manager takes a task with the dependencies it then has
}

function run(settings, args) {
    return author.Command("exec", { exe: settings.program || "hangtime-batch", args: args });
}
