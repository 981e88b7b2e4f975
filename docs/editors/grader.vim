" In ~/.vim/compiler/grader.vim: `:compiler grader` and `:make` fill the quickfix list.
let current_compiler = "grader"
CompilerSet makeprg=grader\ inspect\ .\ --format\ concise
CompilerSet errorformat=%f:%l:%c:\ %m,%-G%.%#
