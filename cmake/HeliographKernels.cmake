# helio_add_kernels(TARGET file.comp...): compiles kernels to SPIR-V and embeds them.
