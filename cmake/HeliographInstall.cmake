# cmake --install: library, headers, package configuration.
