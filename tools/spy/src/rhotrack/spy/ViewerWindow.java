// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import javax.swing.JFrame;
import javax.swing.WindowConstants;

import rhotrack.spy.scene.Feed;
import rhotrack.spy.scene.Model;

/** The window; the subscription that feeds it ends with it. */
final class ViewerWindow {
    private final JFrame frame = new JFrame("rhotrack");
    private final ViewerPanel panel;

    ViewerWindow(Model model, Feed feed, int width, int height) {
        panel = new ViewerPanel(model);
        frame.setDefaultCloseOperation(WindowConstants.DISPOSE_ON_CLOSE);
        frame.setContentPane(panel);
        frame.setSize(width, height);
        frame.setLocationByPlatform(true);
        frame.addWindowListener(new WindowAdapter() {
            @Override
            public void windowClosed(WindowEvent event) {
                panel.stop();
                feed.close();
            }
        });
    }

    void open() {
        panel.start();
        frame.setVisible(true);
        panel.requestFocusInWindow(); // its keys work only while something in the window has the focus
    }

    boolean isOpen() {
        return frame.isDisplayable();
    }

    void toFront() {
        frame.setExtendedState(frame.getExtendedState() & ~JFrame.ICONIFIED);
        frame.toFront();
    }

    void whenClosed(Runnable job) {
        frame.addWindowListener(new WindowAdapter() {
            @Override
            public void windowClosed(WindowEvent event) {
                job.run();
            }
        });
    }
}
