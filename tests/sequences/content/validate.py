# SPDX-License-Identifier: Apache-2.0
"""validate.py SCHEMA FILE…: one line for each YAML file, `ok` or what the JSON Schema has against it."""
import json
import sys

import jsonschema
import yaml

with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
for name in sys.argv[2:]:
    with open(name, encoding="utf-8") as file:
        error = jsonschema.exceptions.best_match(validator.iter_errors(yaml.safe_load(file)))
    print("ok" if error is None else "/".join(map(str, error.absolute_path)) + ": " + error.message.replace("\n", " "))
