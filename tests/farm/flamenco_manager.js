// What Flamenco's Manager gives a job type's script, after its own sources: a task is copied as it is
// added, with the dependencies that it then has.
const author = {
    Task: function (name, type) {
        if (!name.trim() || !type.trim()) throw "author.Task(name, type): both are required";
        const task = { name: name.trim(), type: type.trim(), commands: [], dependencies: [] };
        task.addCommand = function (command) { task.commands.push(command); };
        task.addDependency = function (other) { task.dependencies.push(other.name); };
        return task;
    },
    Command: function (name, parameters) { return { name: name, parameters: parameters }; },
};

function frameChunker(range, size) {
    const frames = [];
    const parts = range.replace(/\.\./g, "-").split(",");
    for (let i = 0; i < parts.length; i++) {
        const ends = parts[i].split("-").map(Number);
        if (ends.length > 2 || ends.some(isNaN) || !parts[i].trim()) throw "invalid range " + range;
        for (let n = ends[0]; n <= ends[ends.length - 1]; n++) {
            if (frames.indexOf(n) < 0) frames.push(n);
        }
    }
    frames.sort(function (a, b) { return a - b; });
    const chunks = [];
    for (let i = 0; i < frames.length; i += size) chunks.push(merged(frames.slice(i, i + size)));
    return chunks;
}

function merged(frames) {
    const runs = [];
    for (let i = 0; i < frames.length; i++) {
        const run = runs[runs.length - 1];
        if (run && run[run.length - 1] + 1 === frames[i]) run.push(frames[i]);
        else runs.push([frames[i]]);
    }
    return runs.map(function (run) {
        return run.length < 3 ? run.join(",") : run[0] + "-" + run[run.length - 1];
    }).join(",");
}

function compiled(submitted) {
    const job = { name: submitted.name, settings: submitted.settings, tasks: [] };
    job.addTask = function (task) { job.tasks.push(JSON.parse(JSON.stringify(task))); };
    compileJob(job);
    return job.tasks;
}
