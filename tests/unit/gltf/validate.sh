#!/usr/bin/env bash
# Usage: validate.sh GLTF_CORPUS FOLDER: writes the corpus into FOLDER and has the Khronos validator judge it.
# The validator is the npm package gltf-validator, found in NODE_PATH or in $HELIOGRAPH_GLTF_VALIDATOR (a folder
# with node_modules). Where there is none, it says so and exits 77, which ctest counts as left out.
set -euo pipefail
corpus=$1 folder=$2
rm -rf "$folder"
"$corpus" "$folder"
export NODE_PATH=${NODE_PATH:-}${HELIOGRAPH_GLTF_VALIDATOR:+:$HELIOGRAPH_GLTF_VALIDATOR/node_modules}
if ! command -v node >/dev/null || ! node -e 'require("gltf-validator")' 2>/dev/null; then
    echo "left out: there is no node with the package gltf-validator (npm install gltf-validator)"
    exit 77
fi
exec node - "$folder" <<'JS'
const fs = require("fs"), path = require("path"), validator = require("gltf-validator");
const folder = process.argv[2];
(async () => {
    const files = fs.readdirSync(folder).filter(name => /\.gl(tf|b)$/.test(name)).sort();
    let errors = 0, warnings = 0;
    for (const name of files) {
        const data = new Uint8Array(fs.readFileSync(path.join(folder, name)));
        const report = await validator.validateBytes(data, {uri: name});
        errors += report.issues.numErrors;
        warnings += report.issues.numWarnings;
        for (const m of report.issues.messages) {
            if (m.severity <= 1) console.log(`${name}: ${["error", "warning"][m.severity]} ${m.code} ${m.pointer || ""}: ${m.message}`);
        }
    }
    console.log(`gltf-validator ${validator.version()}: ${files.length} files, ${errors} errors, ${warnings} warnings`);
    process.exit(errors > 0 || files.length == 0 ? 1 : 0);
})();
JS
