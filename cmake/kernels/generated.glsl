// Empty at build; a kernel variant's generated text takes its place at run time.
