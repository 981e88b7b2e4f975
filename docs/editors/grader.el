;; In ~/.emacs.d/init.el: `M-x eglot` in a file of a robot starts `grader lsp`. Eglot is in Emacs 29.
(add-to-list 'auto-mode-alist
             '("\\.\\(urdf\\|xacro\\|srdf\\|sdf\\|world\\|launch\\)\\'" . nxml-mode))
(add-to-list 'auto-mode-alist
             (cons "\\.rviz\\'" (if (fboundp 'yaml-mode) 'yaml-mode 'yaml-ts-mode)))
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs
               '((nxml-mode yaml-mode yaml-ts-mode) . ("grader" "lsp"))))
